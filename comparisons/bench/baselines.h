// The baselines of steps and of static solvers: damped dynamics until rest, LAMMPS, and PETSc with algebraic multigrid.
#pragma once

#include <string>

#include "msm/dynamics/dynamics.h"
#include "msm/embedding/boundary.h"
#include "msm/laws/laws.h"
#include "msm/statics/equilibrium.h"
#include "msm/topology/network.h"
#include "problem/processes/child.h"

namespace springproof::bench {

/// run_dynamics() from rest with the largest safe step and the best mass-proportional damping, 2 sqrt(lmin), lmin the
/// smallest squared frequency [1/s^2] of the linearised model, until the unbalanced force falls below the tolerance.
/// `factor` multiplies that damping, which it takes no time to find.
DynamicsResult relax(const MassSpringModel& model, const BoundaryConditions& conditions, double tolerance,
                     double factor = 1);

/// The same springs in LAMMPS (lmp on PATH): atom_style bond, bond_style harmonic, no pair style, lists never rebuilt.
class Lammps {
 public:
  /// lmp on PATH, or what SPRINGPROOF_LAMMPS names.
  static bool available();

  /// Writes the data file: springs in the network's order (by first node), positions moved().  Nodes of more than 64
  /// different masses all get the mean one, since LAMMPS has masses per type.
  explicit Lammps(const Network& network);

  /// CPU time of one step [s]: the difference between a run of many steps and a run of one, over the number of steps,
  /// each the least of `runs` runs.  The steps take about `seconds_of_steps`, or as long as reading the data, whichever
  /// is longer.
  /// @throws std::runtime_error if LAMMPS fails, with its error message.
  double seconds_per_step(double seconds_of_steps, int runs) const;

  /// LAMMPS' forces at the positions moved() [N].
  NodalVectors forces() const;

 private:
  double seconds_of(const std::string& commands) const;  ///< CPU time of the whole process

  TemporaryFolder folder_;
  std::string set_up_;  ///< the commands before those that run
  long nodes_, springs_;
};

/// Of the stiffness assembled for PETSc, CG with algebraic multigrid (GAMG).
struct GamgResult {
  bool converged = false;
  int iterations = 0;
  double setup_seconds = 0, solve_seconds = 0;  ///< CPU time; the assembly is not counted
  double difference = 0;                        ///< of the displacement from another, relative (L2)
};

/// Whether this program was built with PETSc.
bool has_gamg();

/// Solves the linearised model for the nodes that are not clamped: MATAIJ, block size 3, rigid-body modes as near null
/// space, |r| / |f| <= tolerance; PETSc's options apply (PETSC_OPTIONS).  Nodes are clamped in all components or in
/// none, prescribed displacements are zero.  `other`: what to compare with, n x 3.  Starts PETSc, so once per process.
/// @throws PetscFailure, or std::runtime_error if PETSc is not there.
GamgResult solve_gamg(const MassSpringModel& model, const BoundaryConditions& conditions, double tolerance,
                      const NodalVectors& other);

}  // namespace springproof::bench
