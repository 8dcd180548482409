#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "meshes/volume.h"
#include "msm/algebra/direct_solver.h"
#include "msm/algebra/fixed.h"
#include "msm/parameters/calibrate.h"
#include "msm/statics/equilibrium.h"
#include "msm/statics/mixed_form.h"
#include "msm/statics/stiffness_solver.h"
#include "problem/system/progress.h"
#include "problem/system/run_cost.h"

namespace springproof {
namespace {

constexpr long lattice_cholesky_limit = 1000;  // free unknowns; above it multigrid is faster
// Up to it a factorisation is tried where the iteration fails; above it, of the mixed form, cycles in displacements:
// slow near nu = 1/2, but thin shells of two cells across, in which the mixed cycle stands still, take some 700.
constexpr long judge_limit = 20000;

NodalVectors nodal(const Eigen::VectorXd& v) { return by_point(v); }

/// The linear problem: u = prescribed + du, du zero on fixed unknowns.
struct LinearProblem {
  const MassSpringModel& model;
  std::vector<char> fixed;  ///< carried ones included
  const LinearOptions& options;
  Eigen::VectorXd prescribed, external;
};

void finish(const LinearProblem& p, const Eigen::VectorXd& u, const Eigen::VectorXd& internal, Equilibrium& result) {
  Eigen::VectorXd support = internal - p.external;
  for (std::size_t i = 0; i < p.fixed.size(); ++i)
    if (!p.fixed[i]) support[static_cast<Eigen::Index>(i)] = 0;
  result.displacement = nodal(u);
  carry(p.model.network.cells.carried, result.displacement);
  result.support = nodal(support);
}

void report(const KrylovResult& k, const std::string& name, Equilibrium& result) {
  result.solver = name;
  result.iterations = k.iterations;
  result.residual = k.residual;
  result.ok = k.converged;
  result.message.clear();
  if (!k.converged)
    result.message = fmt::format("{} did not converge: residual {:.2e} after {} iterations{}", name, k.residual,
                                 k.iterations, k.negative_curvature ? " (stiffness not positive definite)" : "");
}

void solve_primal(const LinearProblem& p, bool direct, Equilibrium& result) {
  const auto K = solver_for(p.model, p.fixed, direct ? std::numeric_limits<long>::max() : 0);
  if (!K->take(p.model.network.X)) {
    result.message = "the stiffness is not positive definite: the model has zero-energy or unstable modes here";
    result.solver = K->name();
    return;
  }
  Eigen::VectorXd Ku, du;
  K->multiply(p.prescribed, Ku);
  // A factorisation is a preconditioner too: one or two steps remove its round-off.
  report(K->solve(p.external - Ku, p.options.tolerance, p.options.max_iterations, du), K->name(), result);
  const Eigen::VectorXd u = p.prescribed + du;
  K->multiply(u, Ku);
  finish(p, u, Ku, result);
}

/// The prescribed displacements, and at corners those of a node that they are anchored to: so residuals are relative to
/// forces of cells, not to those of anchors, which near nu = 1/2 are much larger.
Eigen::VectorXd start_of(const LinearProblem& p) {
  Eigen::VectorXd u = p.prescribed;
  for (const Anchor& a : p.model.network.anchors)
    for (const int n : a.corners)
      for (int d = 0; d < 3; ++d)
        if (p.fixed[3 * a.node + d] && !p.fixed[3 * n + d]) u[3 * n + d] = p.prescribed[3 * a.node + d];
  return u;
}

void solve_mixed(const LinearProblem& p, Equilibrium& result) {
  const auto system = saddle_point_at_rest(p.model, p.fixed);
  const double unit = affine_shear_modulus(p.model) * p.model.network.cells.edge;
  // u = start + du: move the known part to the right-hand side of both equations.
  const MixedVector start{start_of(p), Eigen::VectorXd::Zero(system->compliance().size())},
      b{p.external / unit - system->force(start), -system->volume_change(start.u)};
  MixedVector x;
  report(solve_saddle_point(*system, p.fixed, b, p.options.tolerance, p.options.max_iterations, x),
         "GMRES + mixed multigrid", result);
  x.u += start.u;
  finish(p, x.u, unit * system->force(x), result);
}

}  // namespace

Equilibrium solve_linear(const MassSpringModel& model, const BoundaryConditions& conditions,
                         const LinearOptions& options) {
  const double start = cpu_seconds();
  Equilibrium result;
  const LinearProblem problem{model, fixed_or_carried(model.network, conditions.fixed), options,
                              flat(conditions.prescribed), flat(conditions.external)};
  for (char fixed : problem.fixed) result.unknowns += !fixed;
  progress::detail([&] { return fmt::format("{} unknowns", result.unknowns); });
  LinearSolver solver = options.solver;
  if (solver == LinearSolver::automatic) {
    if (result.unknowns <= (on_lattice(model) ? lattice_cholesky_limit : cholesky_limit))
      solver = LinearSolver::cholesky;
    else
      solver = mixed_form_pays(model) ? LinearSolver::mixed_multigrid : LinearSolver::multigrid;
  }
  try {
    if (solver == LinearSolver::mixed_multigrid)
      solve_mixed(problem, result);
    else
      solve_primal(problem, solver == LinearSolver::cholesky, result);
    const bool iterated = solver != LinearSolver::cholesky && options.solver == LinearSolver::automatic;
    const bool factor = result.unknowns <= judge_limit;
    if (!result.ok && iterated && (factor || solver == LinearSolver::mixed_multigrid))
      solve_primal(problem, factor, result);
  } catch (const std::runtime_error& e) {
    result.message = e.what();
  }
  result.seconds = cpu_seconds() - start;
  result.memory_MiB = peak_memory_MiB();
  return result;
}

NodalVectors support_forces(const MassSpringModel& model, const NodalVectors& x, const BoundaryConditions& conditions) {
  NodalVectors support = -forces(model, x) - conditions.external;
  for (Eigen::Index i = 0; i < support.size(); ++i)
    if (!conditions.fixed[i]) support.data()[i] = 0;
  return support;
}

Field to_field(const Equilibrium& equilibrium, std::shared_ptr<const Mesh> mesh, const Embedding& embedding,
               const Network& network, const std::vector<Load>& loads, const BoundaryConditions& conditions,
               Kinematics kinematics) {
  Field field;
  field.displacement = embedding.weights * equilibrium.displacement;
  field.reactions =
      patch_reactions(loads, *mesh, network.X, conditions, equilibrium.support, equilibrium.displacement, kinematics);
  field.volume_change = volume_change(*mesh, field.displacement);
  field.volume_change_first_order = volume_change_first_order(*mesh, field.displacement);
  field.mesh = std::move(mesh);
  return field;
}

}  // namespace springproof
