// Matrix-free solver of the elastic system.  This file is compiled once per vector width.
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

#include "fem_reference/solvers/finite_operator.h"
#include "fem_reference/solvers/linear.h"
#include "fem_reference/solvers/mixed_operator.h"
#include "fem_reference/solvers/newton.h"
#include "fem_reference/solvers/stiffness.h"
#include "fem_reference/solvers/tetrahedra_operator.h"
#include "fem_reference/solvers/v_cycle.h"
#include "fem_reference/system/elastic_system.h"

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

constexpr unsigned int active_cells = dealii::numbers::invalid_unsigned_int;

// The operator of the multigrid: the stiffness of the displacement form, or for the mixed form its shear part alone.
Coefficients<float> smoothed(const ElasticSystem& system) {
  if (system.form == Form::mixed) return {float(system.mu), 0, false};
  return {float(system.mu), float(system.lambda), system.form == Form::mean_dilatation};
}

template <int degree>
class LinearOperator {
 public:
  explicit LinearOperator(const ElasticSystem& system)
      : mixed_(system.form == Form::mixed),
        stiffness_(*system.body.mapping, system.dof_handler, active_cells, system.constrained,
                   {system.mu, mixed_ ? 0 : system.lambda, system.form == Form::mean_dilatation}),
        multigrid_(system, smoothed(system)) {
    if (mixed_) with_pressure_.emplace(stiffness_, system.lambda);
  }

  MixedVector vector() const {
    if (mixed_) return with_pressure_->vector();
    return {stiffness_.vector(), {}};
  }
  void apply(MixedVector& f, const MixedVector& x) const {
    mixed_ ? with_pressure_->apply(f, x) : stiffness_.apply(f.u, x.u);
  }
  void vmult(MixedVector& y, const MixedVector& x) const {
    mixed_ ? with_pressure_->vmult(y, x) : stiffness_.vmult(y.u, x.u);
  }
  void precondition_displacement(Vector<double>& z, const Vector<double>& r) const { multigrid_.vmult(z, r); }
  void precondition_pressure(Vector<double>& z, const Vector<double>& r) const {
    with_pressure_->precondition_pressure(z, r);
  }
  void couple(Vector<double>& f, const Vector<double>& p) const { with_pressure_->couple(f, p); }
  void clear_constrained(Vector<double>& f) const { stiffness_.clear_constrained(f); }
  CellPressures pressures(const MixedVector& x) const { return with_pressure_->pressures(x); }
  bool factorise(const MixedVector&) { return false; }

 private:
  bool mixed_;
  Stiffness<degree, double> stiffness_;
  std::optional<MixedOperator<degree>> with_pressure_;
  VCycle<degree> multigrid_;
};

template <int degree>
class TangentOperator : public FiniteOperator<degree> {
 public:
  TangentOperator(const Stiffness<degree, double>& base, const ElasticSystem& system, Law law)
      : FiniteOperator<degree>(base, law, system.form, system.lambda), multigrid_(system, smoothed(system)) {}

  void prepare(const MixedVector& x) { multigrid_.deform(x.u); }
  bool factorise(const MixedVector&) { return false; }
  void precondition_displacement(Vector<double>& z, const Vector<double>& r) const { multigrid_.vmult(z, r); }

 private:
  VCycle<degree> multigrid_;
};

template <int degree>
ElasticAnswer small_strain(const ElasticSystem& system, const DofVector& load, DofVector& displacement) {
  return solve_linear(LinearOperator<degree>(system), system, load, displacement);
}

template <int degree>
FiniteAnswer finite_strain(const ElasticSystem& system, const FiniteProblem& problem, const DofVector& load,
                           DofVector& displacement) {
  const Stiffness<degree, double> base(*system.body.mapping, system.dof_handler, active_cells, system.constrained,
                                       {system.mu, 0, false});
  TangentOperator<degree> K(base, system, problem.law);
  return Newton<TangentOperator<degree>>(K, system, problem, load).solve(displacement);
}

ElasticAnswer solve_elastic(const ElasticSystem& system, const DofVector& load, DofVector& displacement) {
  const bool tetrahedra = system.body.has_tetrahedra();
  ElasticAnswer answer = tetrahedra           ? solve_linear(TetrahedraOperator(system), system, load, displacement)
                         : system.degree == 1 ? small_strain<1>(system, load, displacement)
                                              : small_strain<2>(system, load, displacement);
  answer.method = system.form == Form::mixed ? "GMRES, matrix-free" : "CG, matrix-free";
  answer.method += tetrahedra ? ", linear elements by " + system.below_name : " multigrid";
  return answer;
}

FiniteAnswer solve_finite(const ElasticSystem& system, const FiniteProblem& problem, const DofVector& load,
                          DofVector& displacement) {
  FiniteAnswer answer = system.degree == 1 ? finite_strain<1>(system, problem, load, displacement)
                                           : finite_strain<2>(system, problem, load, displacement);
  answer.method = "Newton, GMRES, matrix-free multigrid";
  return answer;
}

}  // namespace

extern const Solvers solvers = {solve_elastic, solve_finite};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
