// Motion in time, and natural modes, by finite elements with consistent mass on one grid.
#pragma once

#include <deal.II/dofs/dof_handler.h>

#include "fem_reference/grid/grid_problem.h"
#include "fem_reference/grid/triangulate.h"

namespace springproof::fem {

/// Integrates GridProblem::motion in equal steps of the implicit midpoint rule: of second order, without damping of its
/// own, symplectic, with exact linear and angular momentum; for small strain it is Newmark's average acceleration. With
/// MotionRequest::energy_momentum its stress is that of step_residual(), so that energy is exact too.  A step is solved
/// by Newton's method with factors (MUMPS) that are kept while it converges; pressures of the mixed form are unknowns
/// beside the displacements.  Sets the time, path, kinetic energy, last displacement and description of the solution.
/// Loads and pressures are dead loads.
/// @throws InputError for several processes.
void solve_motion(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                  Solution& solution);

/// The problem's first `modes` natural modes, its supports at rest and its other loads left out: SLEPc's Krylov-Schur
/// method about a shift below zero (MUMPS); that no eigenvalue was passed over follows from the inertia of K - sigma M
/// above the last.  In the mixed form (element.h) the pressures are unknowns without mass: a saddle point, about a
/// shift below zero quasi-definite.  Sets the frequencies, shapes, residual and description of the solution.
/// @throws InputError for several processes.
void solve_modes(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                 Solution& solution);

}  // namespace springproof::fem
