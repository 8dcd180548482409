// The grids of a finite element request, one by one.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "comparisons/reference/run_keeper.h"
#include "fem_reference/exchange/reference.h"

namespace springproof {

/// Called with the number of a grid as soon as it has a result.
using Solved = std::function<void(std::size_t grid, const fem::Solution& solution)>;

/// Solves each grid by itself, the coarsest first, and gives the solutions in the order of the request.  What the
/// program dies of on one grid takes with it the finer ones of that element, no other; graded grids are not tried after
/// a coarser one that has no result, as they would take minutes to fail.
/// @throws what fem::solve() throws, if it throws on every grid; NoRoom; std::runtime_error if interrupted.
std::vector<fem::Solution> solve_each(const fem::Request& request, const RunKeeper& keeper = {},
                                      const Solved& solved = {});

}  // namespace springproof
