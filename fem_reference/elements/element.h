// The finite elements, by name, and the formulation used with each.
#pragma once

#include <string>

namespace springproof::fem {

struct Element {
  bool tetrahedra;
  int degree;  ///< 1 or 2
};

/// Of "q1", "q2", "p1", "p2".
/// @throws InputError naming the allowed ones.
Element element_named(const std::string& name);

/// Stress = mu (grad u + grad u^T) + lambda div u I, with div u taken
enum class Form {
  pointwise,        ///< as it is
  mean_dilatation,  ///< as its mean over each cell (B-bar, Hughes 1980)
  mixed  ///< projected onto the pressure space, with the pressures as unknowns: one constant (Q1) or four linear
         ///< functions (Q2) per cell, continuous linear functions (P2, Taylor and Hood 1973)
};

/// For nearly incompressible solids the pressure becomes an unknown, so that accuracy and solver are robust in
/// Poisson's ratio.  P1 has no stable pressure space: it keeps the pointwise form, and locks.
Form form_for(const Element& element, double poisson_ratio, bool small_strain);

/// "Q2 displacement", "P2-P1 mixed", "Q1 B-bar", ...
std::string describe(const Element& element, Form form);

}  // namespace springproof::fem
