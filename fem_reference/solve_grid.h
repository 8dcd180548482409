// Solves one discretisation in this process: called by `springproof-fem` for each grid, and by the tests of the
// elements.  No deal.II in this header.
#pragma once

#include <functional>

#include "fem_reference/grid/grid_problem.h"
#include "problem/system/input_error.h"

namespace springproof::fem {

/// The caller sets Solution::grid.  A solver that fails gives ok = false.
/// @throws InputError if the problem cannot be used: unknown patch or law, unconstrained body, point outside
/// it.
Solution solve_grid(const GridProblem& problem);

/// The mesh of quadratic tetrahedra with so many times as many, or fewer if edges would go below a 64th of their mean,
/// cut where errors at small strain are largest; that of other elements as it is.
/// @throws std::runtime_error if the linear solver fails, InputError on several processes
Mesh refined_locally(GridProblem problem, double times_cells);

/// Grades coordinates in the box [low, high] towards its faces, within half the shortest side r on every axis: the
/// distance d < r to a face becomes r (d/r)^exponent.  The faces are fixed, and the rest of a slender body stays
/// uniform.
std::function<Vec3(const Vec3&)> graded(const Vec3& low, const Vec3& high, double exponent);

/// "deal.II 9.4.1, AVX2" or "..., one lane": the solver used on this machine.
std::string library_versions();

}  // namespace springproof::fem
