// What of its cases a comparison is restricted to, and how finely their references are resolved.
#pragma once

#include <vector>

#include "problem/case_file/experiment.h"

namespace springproof {

/// Restricts a case to the requested settings, and to the expectations at these or at every one; none
/// requested: all of it.
/// @throws InputError if it has none of them.
Experiment only(const std::vector<double>& wanted, Experiment experiment);

/// Multiplies the cells of the reference's grids along each direction, except in directions of one cell.
/// @throws InputError if the case leaves the choice of its reference grids to the program.
Experiment finer(int times, Experiment experiment);

}  // namespace springproof
