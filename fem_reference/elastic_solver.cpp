// Matrix-free solver of the linear-elastic system.  This file is compiled once per vector width.
//
// Debian's deal.II is built without vectorisation; defining the width here, after config.h, makes the wide
// VectorizedArray types exist in this file while the library's default stays one lane.  What the library
// lacks for the wide types is instantiated from its own template files.
#include <deal.II/base/config.h>
#if SPRINGPROOF_VECTOR_BITS > 0
#undef DEAL_II_VECTORIZATION_WIDTH_IN_BITS
#define DEAL_II_VECTORIZATION_WIDTH_IN_BITS SPRINGPROOF_VECTOR_BITS
#endif
#include <deal.II/base/vectorization.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/matrix_free/fe_evaluation.h>
#if SPRINGPROOF_VECTOR_BITS > 0
#define FE_EVAL_FACTORY_DEGREE_MAX 2
#include <deal.II/matrix_free/dof_info.templates.h>
#include <deal.II/matrix_free/evaluation_template_face_factory.templates.h>
#undef dealii_matrix_free_evaluation_template_factory_templates_h  // 9.4.1 guards both files with one macro
#include <deal.II/matrix_free/evaluation_template_factory.templates.h>
#include <deal.II/matrix_free/evaluation_template_factory_hanging_nodes.templates.h>
#include <deal.II/matrix_free/mapping_info.templates.h>
#include <deal.II/matrix_free/matrix_free.templates.h>
#include <deal.II/matrix_free/shape_info.templates.h>
#endif

#include "fem_reference/elastic_system.h"
#include "fem_reference/krylov.h"
#include "fem_reference/mixed_operator.h"
#include "fem_reference/newton.h"
#include "fem_reference/stiffness.h"
#include "fem_reference/v_cycle.h"

#if SPRINGPROOF_VECTOR_BITS > 0
DEAL_II_NAMESPACE_OPEN
namespace internal {
using WideFloat = VectorizedArray<float, SPRINGPROOF_VECTOR_BITS / 32>;
using WideDouble = VectorizedArray<double, SPRINGPROOF_VECTOR_BITS / 64>;
template struct FEEvaluationFactory<3, WideFloat>;
template struct FEEvaluationFactory<3, WideDouble>;
template struct FEEvaluationHangingNodesFactory<3, float, WideFloat>;
template struct FEEvaluationHangingNodesFactory<3, double, WideDouble>;
}  // namespace internal
DEAL_II_NAMESPACE_CLOSE
#endif

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {
namespace {

template <int degree>
ElasticAnswer solve_displacement_form(const ElasticSystem& system, const DofVector& load, DofVector& u) {
  const bool mean = system.form == Form::mean_dilatation;
  const Stiffness<degree, double> K(system.dof_handler, dealii::numbers::invalid_unsigned_int,
                                    system.constrained, {system.mu, system.lambda, mean});
  const VCycle<degree> multigrid(system, {float(system.mu), float(system.lambda), mean});

  ElasticAnswer answer;
  answer.method = "CG, matrix-free multigrid";
  Vector<double> x = K.vector(), r = K.vector(), du = K.vector();
  x = u;
  answer.internal_force.reinit(r);
  double start = 0;
  for (int repeat = 0; repeat < 4; ++repeat) {
    K.apply(answer.internal_force, x);
    r = load;
    r -= answer.internal_force;
    K.clear_constrained(r);
    const double norm = r.l2_norm();
    if (repeat == 0) start = norm;
    answer.residual = start > 0 ? norm / start : 0;
    answer.converged = answer.residual <= system.tolerance;
    if (answer.converged || repeat == 3) break;
    dealii::SolverControl control(1000, 0.5 * system.tolerance * start);
    dealii::SolverCG<Vector<double>> cg(control);
    du = 0;
    try {
      cg.solve(K, du, r, multigrid);
    } catch (const dealii::SolverControl::NoConvergence&) {
    }
    answer.iterations += control.last_step();
    x += du;
  }
  u = x;
  return answer;
}

template <int degree>
ElasticAnswer solve_mixed_form(const ElasticSystem& system, const DofVector& load, DofVector& displacement) {
  const Stiffness<degree, double> shear(system.dof_handler, dealii::numbers::invalid_unsigned_int,
                                        system.constrained, {system.mu, 0, false});
  const VCycle<degree> multigrid(system, {float(system.mu), 0, false});
  const MixedOperator<degree> K(shear, system.lambda);
  const auto precondition = [&](MixedVector& z, const MixedVector& r) {
    multigrid.vmult(z.u, r.u);
    K.precondition_pressure(z.p, r.p);
  };

  ElasticAnswer answer;
  answer.method = "MINRES, matrix-free multigrid";
  MixedVector x = K.vector(), r = K.vector(), f = K.vector(), z = K.vector(), dx = K.vector();
  x.u = displacement;
  double start = 0, start_force = 0;
  for (int repeat = 0; repeat < 6; ++repeat) {
    K.apply(f, x);
    r.u = load;
    r.u -= f.u;
    shear.clear_constrained(r.u);
    r.p = f.p;
    r.p *= -1;
    precondition(z, r);
    const double norm = std::sqrt(z.dot(r)), norm_force = r.u.l2_norm();
    if (repeat == 0) start = norm, start_force = norm_force;
    answer.residual = start > 0 ? std::max(norm / start, start_force > 0 ? norm_force / start_force : 0) : 0;
    answer.converged = answer.residual <= system.tolerance;
    if (answer.converged || repeat == 5) break;
    dx.sadd(0, 0, r);
    const auto outcome = minres([&](MixedVector& y, const MixedVector& v) { K.vmult(y, v); }, precondition, r,
                                0.3 * system.tolerance / answer.residual, 2000, dx);
    answer.iterations += outcome.iterations;
    x.add(1, dx);
  }
  displacement = x.u;
  answer.internal_force = f.u;
  return answer;
}

}  // namespace

ElasticAnswer solve(const ElasticSystem& system, const DofVector& load, DofVector& displacement) {
  if (system.form == Form::mixed)
    return system.degree == 1 ? solve_mixed_form<1>(system, load, displacement)
                              : solve_mixed_form<2>(system, load, displacement);
  return system.degree == 1 ? solve_displacement_form<1>(system, load, displacement)
                            : solve_displacement_form<2>(system, load, displacement);
}

FiniteAnswer solve(const ElasticSystem& system, const FiniteProblem& problem, const DofVector& load,
                   DofVector& displacement) {
  FiniteAnswer answer = system.degree == 1 ? Newton<1>(system, problem, load).solve(displacement)
                                           : Newton<2>(system, problem, load).solve(displacement);
  answer.method = "Newton, GMRES, matrix-free multigrid";
  return answer;
}

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
