// The baseline of the static solver: the stiffness assembled for PETSc, CG with algebraic multigrid (GAMG).
#pragma once

#include <string>

#include "msm/embedding/boundary.h"
#include "msm/laws/laws.h"

namespace springproof::bench {

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
