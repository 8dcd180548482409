// Interface of the finite element reference, without deal.II.
//
// solve() runs the separate program `springproof-fem` (found beside the running executable), so that programs without
// need of FEM do not load it, and a crash of the reference cannot take its caller down.
#pragma once

#include <string>
#include <vector>

#include "fem_reference/exchange/request.h"
#include "problem/system/input_error.h"

namespace springproof::fem {

/// Solves on every grid, in order.  A grid that fails has ok = false; it does not throw.
/// @throws InputError if the experiment cannot be used (no such patch, unconstrained body, unknown law).
/// @throws std::runtime_error if the program cannot be run or is killed (with its last error output).
std::vector<Solution> solve(const Request& request);

/// Runs the program with these arguments, its output going to ours, and returns its exit status.
/// @throws std::runtime_error if it is not found or is killed.
int run_program(const std::vector<std::string>& arguments);

/// True if `springproof-fem` is found.
bool available();

/// "deal.II 9.4.1, AVX2" of the program, empty if not available.
std::string version();

}  // namespace springproof::fem
