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
#include "fem_reference/solvers/tetrahedra_operator.h"
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

template <int degree>
ElasticAnswer small_strain(const ElasticSystem& system, const DofVector& load, DofVector& displacement) {
  return solve_linear(LinearOperator<degree>(system), system, load, displacement);
}

template <int degree>
FiniteAnswer finite_strain(const ElasticSystem& system, const FiniteProblem& problem, const DofVector& load,
                           DofVector& displacement) {
  FiniteOperator<degree> K(system, problem.law);
  return Newton<FiniteOperator<degree>>(K, system, problem, load).solve(displacement);
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
