// The grids of a finite element request: what each is expected to take, from its number of unknowns, and all solved one
// by one.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "comparisons/reference/run_keeper.h"
#include "fem_reference/exchange/reference.h"
#include "problem/case_file/experiment.h"

namespace springproof {

double unknowns(const Cells& cells, int degree);  ///< of a block's nodes

/// Of a mesh's nodes, with those that degree 2 adds on edges (of tetrahedra), faces and in cells.
double unknowns(const Mesh& mesh, int degree);

int degree_of(const std::string& element);  ///< 2 of "q2"

/// fem::Discretisation::times_cells of an element of [reference].
double times_cells(const Experiment& experiment, const std::string& element);

/// An equilibrium takes so many times as long as one of linear theory far from nu = 1/2.
double factor_of(const IsotropicMaterial& material, bool finite);

RunCost grid_cost(double unknowns, bool assembled, double factor);

/// What the first grid of the request is expected to take on one core.
RunCost cost_of(const fem::Request& request);

/// Called with the number of a grid as soon as it has a result.
using Solved = std::function<void(std::size_t grid, const fem::Solution& solution)>;

/// Solves each grid by itself, the coarsest first, and gives the solutions in the order of the request.  What the
/// program dies of on one grid takes with it the finer ones of that element, no other; graded grids are not tried after
/// a coarser one that has no result, as they would take minutes to fail.
/// @throws what fem::solve() throws, if it throws on every grid; NoRoom; std::runtime_error if interrupted.
std::vector<fem::Solution> solve_each(const fem::Request& request, const RunKeeper& keeper = {},
                                      const Solved& solved = {});

}  // namespace springproof
