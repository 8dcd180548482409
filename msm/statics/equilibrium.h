// Static equilibrium: options, results and functions of the linear and the large-displacement solver.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "msm/embedding/boundary.h"
#include "msm/laws/laws.h"

namespace springproof {

/// Why a state of large displacements is the last one.
enum class Loss { none, unstable, inverted_cell, no_convergence };

/// The motion that a state resists least, compared with how it resists it at rest.
struct SoftestMotion {
  double stiffness;  ///< u^T K u over that of the tangent at rest; 0: the equilibrium is lost
  Vec3 alternation;  ///< along each axis of a lattice: 0 neighbours move alike, 2 against each other
};

/// Result of a static solver.
struct Equilibrium {
  bool ok = false;            ///< whether there is a result
  std::string message;        ///< why there is no result, and the load reached
  NodalVectors displacement;  ///< [m]
  NodalVectors support;       ///< force of the supports on each node [N], zero on free unknowns
  std::string solver;         ///< description of the solver
  int iterations = 0;         ///< of the linear solver (solve_finite(): of Newton's method, all steps together)
  double residual = 0;        ///< |unbalanced force| / |force scale|, of the returned state
  double load_reached = 1;    ///< fraction of the load
  double seconds = 0;         ///< CPU time of the thread
  long unknowns = 0;          ///< free unknowns
  double memory_MiB = 0;      ///< largest resident memory of the program so far
  Loss loss = Loss::none;     ///< of solve_finite(): why there is no stable state beyond load_reached
  std::optional<SoftestMotion> softest = {};  ///< of the returned state, if it was asked for
};

/// Solvers of the linear equations; mixed_multigrid has pressures as unknowns, for nu near 1/2.
enum class LinearSolver { automatic, cholesky, multigrid, mixed_multigrid };

/// How to solve a linear problem.
struct LinearOptions {
  LinearSolver solver = LinearSolver::automatic;  ///< Cholesky when small, else multigrid; lattices with a volume
                                                  ///< correction or symmetric dispersion: mixed above nu = 0.4
  double tolerance = 1e-10;                       ///< relative residual
  int max_iterations = 2000;                      ///< of the iterative solvers
};

/// Equilibrium of the model linearised at rest.
/// @param model a model
/// @param conditions supports, which leave no rigid motion (require_supported()), and loads
/// @param options solver and tolerance
/// @return displacement, support forces and how they were found; check `ok`
Equilibrium solve_linear(const MassSpringModel& model, const BoundaryConditions& conditions,
                         const LinearOptions& options = {});

/// How to solve a problem of large displacements.
struct NewtonOptions {
  double tolerance = 1e-9;            ///< relative residual
  double first_step = 0.25;           ///< fraction of the load
  double smallest_step = 1.0 / 1024;  ///< fraction of the load below which the solver gives up
  int max_iterations = 25;            ///< per load step
  bool softest_motion = false;        ///< of conservative models: Equilibrium::softest, some ten solutions more
};

/// Boundary conditions at a fraction of the load (rotations are not linear in it).
using LoadPath = std::function<BoundaryConditions(double factor)>;

/// Large-displacement equilibrium: Newton's method with adaptive load steps and a line search on the energy.
/// A state is accepted only if its tangent is positive definite and no cell is inverted; otherwise ok = false, with
/// the load reached and the reason (limit point or buckling, inverted cell, no convergence).
/// @param model one that holds at large displacement
/// @param load_path conditions at a fraction of the load, as transfer(loads, mesh, density, Kinematics::finite, factor)
/// @param options tolerances and load steps
/// @return the state reached; check `ok`
Equilibrium solve_finite(const MassSpringModel& model, const LoadPath& load_path, const NewtonOptions& options = {});

/// Force of the supports on each node.
/// @param model a model
/// @param x positions [m], n x 3
/// @param conditions with the fixed unknowns and the loads
/// @return [N], n x 3, zero on free unknowns
NodalVectors support_forces(const MassSpringModel& model, const NodalVectors& x, const BoundaryConditions& conditions);

/// The Field of an equilibrium of a network in a mesh: what measures are taken of, and what write_vtu() writes.
/// @param equilibrium a result
/// @param mesh of the body
/// @param embedding of the mesh in the network; nodes_of_mesh() where they have the same nodes
/// @param network of the model
/// @param loads those of the conditions
/// @param conditions that were solved
/// @param kinematics of the solver: finite for solve_finite()
/// @return displacement of the mesh's nodes, reaction of each support, change of volume
Field to_field(const Equilibrium& equilibrium, std::shared_ptr<const Mesh> mesh, const Embedding& embedding,
               const Network& network, const std::vector<Load>& loads, const BoundaryConditions& conditions,
               Kinematics kinematics);

}  // namespace springproof
