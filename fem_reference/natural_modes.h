// Natural frequencies and modes by finite elements with consistent mass, at rest, on one grid.
#pragma once

#include <deal.II/dofs/dof_handler.h>

#include "fem_reference/grid/grid_problem.h"
#include "fem_reference/grid/triangulate.h"

namespace springproof::fem {

/// The problem's first `modes` natural modes, its supports at rest and its other loads left out: SLEPc's Krylov-Schur
/// method about a shift below zero (MUMPS); that no eigenvalue was passed over follows from the inertia of K - sigma M
/// above the last.  In the mixed form (element.h) the pressures are unknowns without mass: a saddle point, about a
/// shift below zero quasi-definite.  Sets the frequencies, shapes, residual and description of the solution.
/// @throws InputError for several processes.
void solve_modes(const GridProblem& problem, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                 Solution& solution);

}  // namespace springproof::fem
