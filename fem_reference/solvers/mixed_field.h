// Displacement and pressure, the unknowns of every formulation.  Compiled into each solver's namespace, like linear.h.
#pragma once

#include <deal.II/lac/la_parallel_vector.h>

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

template <typename Number>
using Vector = dealii::LinearAlgebra::distributed::Vector<Number>;

struct MixedField {
  Vector<double> u;  ///< displacement, or force
  Vector<double> p;  ///< pressure coefficients, or residual of the dilatation equation; empty without pressure

  void add(double factor, const MixedField& other) {
    u.add(factor, other.u);
    p.add(factor, other.p);
  }
  /// this = this * s + other * t
  void sadd(double s, double t, const MixedField& other) {
    u.sadd(s, t, other.u);
    p.sadd(s, t, other.p);
  }
  double dot(const MixedField& other) const { return u * other.u + p * other.p; }
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
