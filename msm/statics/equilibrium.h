// Static equilibrium: options, results and functions of the linear and the large-displacement solver.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "msm/embedding/boundary.h"
#include "msm/laws/laws.h"

namespace springproof {

struct Equilibrium {
  bool ok = false;
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
};

enum class LinearSolver { automatic, cholesky, multigrid, mixed_multigrid };

struct LinearOptions {
  LinearSolver solver = LinearSolver::automatic;  ///< Cholesky when small, else multigrid; lattices with a volume
                                                  ///< correction or symmetric dispersion: mixed above nu = 0.4
  double tolerance = 1e-10;                       ///< relative residual
  int max_iterations = 2000;
};

/// Equilibrium of the model linearised at rest.
Equilibrium solve_linear(const MassSpringModel& model, const BoundaryConditions& conditions,
                         const LinearOptions& options = {});

struct NewtonOptions {
  double tolerance = 1e-9;   ///< relative residual
  double first_step = 0.25;  ///< fraction of the load
  double smallest_step = 1.0 / 1024;
  int max_iterations = 25;  ///< per load step
};

/// Boundary conditions at a fraction of the load (rotations are not linear in it).
using LoadPath = std::function<BoundaryConditions(double factor)>;

/// Large-displacement equilibrium: Newton's method with adaptive load steps and a line search on the energy.
/// A state is accepted only if its tangent is positive definite and no cell is inverted; otherwise ok = false, with
/// the load reached and the reason (limit point or buckling, inverted cell, no convergence).
Equilibrium solve_finite(const MassSpringModel& model, const LoadPath& load_path, const NewtonOptions& options = {});

/// Force of the supports on each node at positions x [N], zero on free unknowns.
NodalVectors support_forces(const MassSpringModel& model, const NodalVectors& x, const BoundaryConditions& conditions);

/// The Field of an equilibrium of a network in a mesh, for the comparator.
Field to_field(const Equilibrium& equilibrium, std::shared_ptr<const Mesh> mesh, const Embedding& embedding,
               const Network& network, const std::vector<Load>& loads, const BoundaryConditions& conditions,
               Kinematics kinematics);

}  // namespace springproof
