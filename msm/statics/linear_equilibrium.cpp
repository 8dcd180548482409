#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "meshes/volume.h"
#include "msm/algebra/krylov.h"
#include "msm/multigrid/cell_stiffness.h"
#include "msm/multigrid/cut_mixed_multigrid.h"
#include "msm/multigrid/cut_multigrid.h"
#include "msm/multigrid/dispersion_multigrid.h"
#include "msm/parameters/calibrate.h"
#include "msm/statics/equilibrium.h"
#include "msm/statics/stiffness_solver.h"
#include "problem/system/progress.h"
#include "problem/system/run_cost.h"

namespace springproof {
namespace {

constexpr long lattice_cholesky_limit = 1000;  // free unknowns; above it multigrid is faster
constexpr long judge_limit = 20000;            // up to it a factorisation is tried where the iteration fails

NodalVectors nodal(const Eigen::VectorXd& v) { return Eigen::Map<const NodalVectors>(v.data(), v.size() / 3, 3); }

void keep(const std::vector<char>& fixed, bool on_fixed, Eigen::VectorXd& v) {
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (bool(fixed[i]) != on_fixed) v[i] = 0;
}

/// The linear problem: u = prescribed + du, du zero on fixed unknowns.
struct LinearProblem {
  const MassSpringModel& model;
  std::vector<char> fixed;  ///< carried ones included
  const LinearOptions& options;
  Eigen::VectorXd prescribed, external;
};

void finish(const LinearProblem& p, const Eigen::VectorXd& u, const Eigen::VectorXd& internal, Equilibrium& result) {
  Eigen::VectorXd support = internal - p.external;
  keep(p.fixed, true, support);
  result.displacement = nodal(u);
  carry(p.model.network.carried, result.displacement);
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

/// `unit`: that of stiffness; `volumes`: number of pressures.
template <class Mixed>
void solve_mixed(const LinearProblem& p, Mixed&& multigrid, double unit, std::size_t volumes, Equilibrium& result) {
  // u = prescribed + du: move the prescribed part to the right-hand side of both equations.
  const Eigen::VectorXd no_pressure = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(volumes));
  Eigen::VectorXd f = p.external / unit - multigrid.force(p.prescribed, no_pressure), du, pressure;
  keep(p.fixed, false, f);
  const KrylovResult k = multigrid.solve(f, -multigrid.volume_change(p.prescribed), p.options.tolerance,
                                         p.options.max_iterations, du, pressure);
  report(k, "GMRES + mixed multigrid", result);
  const Eigen::VectorXd u = p.prescribed + du;
  finish(p, u, unit * multigrid.force(u, pressure), result);
}

/// Mixed form with a pressure per node of a lattice with momentum dispersion, else one per cell.
void solve_mixed(const LinearProblem& p, const CellStiffness& cell, double G, Equilibrium& result) {
  const Network& network = p.model.network;
  const double l = network.cell_edge, unit = G * l;
  if (CutMultigrid::covers(p.model))
    solve_mixed(p, CutMixedMultigrid(p.model, p.fixed), unit, network.cells.size(), result);
  else if (dispersion_of(p.model))
    solve_mixed(p, DispersionMultigrid(p.model, p.fixed, G), unit, network.volume.size(), result);
  else
    solve_mixed(p, MixedMultigrid(lattice_levels(network, p.fixed), in_units(cell, G, l)), unit, network.cells.size(),
                result);
}

/// Stiffness of the volume term [Pa] of a lattice for which there is a mixed multigrid.
double volume_stiffness(const MassSpringModel& model, const CellStiffness& cell, double G) {
  if (CutMultigrid::covers(model)) return averaged_springs_of(model)->lame_lambda - G;
  return NodalVolumes::covers(model) ? added_lambda(*dispersion_of(model)) * G : cell.kappa;
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
  const double G = affine_shear_modulus(model);
  const bool has_cells = consists_of_cells(model);
  const CellStiffness cell = has_cells ? cell_stiffness(model) : CellStiffness{};
  if (solver == LinearSolver::automatic) {
    if (result.unknowns <= (has_cells || NodalVolumes::covers(model) || CutMultigrid::covers(model)
                                ? lattice_cholesky_limit
                                : cholesky_limit))
      solver = LinearSolver::cholesky;
    else
      solver = volume_stiffness(model, cell, G) >
                       (CutMultigrid::covers(model) ? cut_cells_mixed_above_kappa : mixed_above_kappa) * G
                   ? LinearSolver::mixed_multigrid
                   : LinearSolver::multigrid;
  }
  try {
    if (solver == LinearSolver::mixed_multigrid)
      solve_mixed(problem, cell, G, result);
    else
      solve_primal(problem, solver == LinearSolver::cholesky, result);
    const bool iterated = solver == LinearSolver::multigrid && options.solver == LinearSolver::automatic;
    if (!result.ok && iterated && result.unknowns <= judge_limit) solve_primal(problem, true, result);
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
