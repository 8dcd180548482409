// Linear statics, for any operator that multiplies by the stiffness.  Part of each solver, like mixed_field.h.
#pragma once

#include <fmt/format.h>

#include "fem_reference/solvers/block_triangular.h"
#include "fem_reference/solvers/krylov.h"
#include "fem_reference/solvers/mixed_field.h"
#include "fem_reference/system/elastic_system.h"
#include "problem/system/progress.h"

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

// Interface of an operator, for small and for finite strain:
//   vector()               zero displacement and pressure
//   apply(f, x)            the stiffness (the tangent) times x on all degrees of freedom
//   vmult(y, x)            the same, with constrained rows and columns eliminated
//   precondition_displacement(z, r), precondition_pressure(z, r)  symmetric, positive definite
//   couple(f, p)           forces of pressures on unconstrained degrees of freedom
//   clear_constrained(f)   zero where displacement is prescribed
//   pressures(x)           CellPressures
//   factorise(x)           precondition_displacement by factors of the stiffness (of the mixed form of its shear part)
//                          at the state x from now on; false if it is so already, or they would be too large
template <typename Operator>
ElasticAnswer solve_linear(Operator&& K, const ElasticSystem& system, const DofVector& load, DofVector& displacement) {
  constexpr int most_stored = 100;  // vectors of GMRES, twice
  constexpr double slow = 0.1;      // reduction of the residual by so many
  const bool mixed = system.form == Form::mixed;
  const int most_repeats = mixed ? 20 : 6;
  const BlockTriangular<std::remove_cvref_t<Operator>> precondition(K, system);
  const ResidualProduct dot(system);
  int products = 0;
  const auto multiply = [&](MixedField& y, const MixedField& v) {
    ++products;
    progress::detail([&] { return fmt::format("{} unknowns, iteration {}", load.size(), products); });
    K.vmult(y, v);
  };
  ElasticAnswer answer;
  MixedField x = K.vector(), r = x, f = x, dx = x;
  x.u = displacement;
  double start = 0;  // reference value of the residual's norm
  for (int repeat = 0; repeat < most_repeats; ++repeat) {
    K.apply(f, x);
    r = f;
    r.sadd(-1, 0, r);
    r.u += load;
    K.clear_constrained(r.u);
    const double norm = std::sqrt(dot(r, r));
    if (repeat == 0) start = norm;
    // Reactions may be far larger than the loads that cause them (slender bodies), and rounding errors scale with them.
    start = std::max(start, f.u.l2_norm());
    answer.residual = start > 0 ? norm / start : 0;
    answer.converged = answer.residual <= system.tolerance;
    if (answer.converged || repeat + 1 == most_repeats) break;
    dx.sadd(0, 0, dx);
    const double reduction = 0.3 * system.tolerance / answer.residual;
    const KrylovOutcome outcome = mixed ? gmres(multiply, precondition, dot, r, reduction, most_stored, dx)
                                        : conjugate_gradients(multiply, precondition, r, reduction, 2000, dx);
    answer.iterations += outcome.iterations;
    x.add(1, dx);
    if (outcome.reduction > slow) K.factorise(x);
  }
  displacement = x.u;
  answer.internal_force = f.u;
  if (mixed) answer.pressure = K.pressures(x);
  return answer;
}

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
