// The elements, by name, and the form of the equations that each takes.
#pragma once

#include <string>

namespace springproof::fem {

struct Element {
  bool tetrahedra;
  int degree;  ///< 1 or 2
};

/// Of "q1", "q2", "p1", "p2".
/// @throws InputError naming those there are.
Element element_named(const std::string& name);

/// Stress = mu (grad u + grad u^T) + lambda div u I, with div u taken
enum class Form {
  pointwise,        ///< as it is
  mean_dilatation,  ///< as its mean over each cell (B-bar)
  mixed  ///< projected on a space of pressures, which are unknowns: one constant (Q1) or four linear functions (Q2) per
         ///< cell, continuous linear functions (P2)
};

/// Where the solid is nearly incompressible the pressure becomes an unknown, so that neither the accuracy nor the
/// solver depends on Poisson's ratio.  P1 has no stable pressure: it stays as it is, and locks.
Form form_for(const Element& element, double poisson_ratio, bool small_strain);

/// "Q2 displacement", "P2-P1 mixed", "Q1 B-bar", ...
std::string describe(const Element& element, Form form);

}  // namespace springproof::fem
