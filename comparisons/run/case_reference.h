// The finite elements of a part that is being run: solved, recorded, and brought to the lattices as their reference.
#pragma once

#include <string>

#include "comparisons/run/part_run.h"

namespace springproof {

/// What is recorded of a solution.
Run fem_run(const PartRun& run, const fem::Solution& solution, const std::string& model);

/// Runs the finite elements of [reference], at rest and in time, and those beside the models; adds their records and
/// sets what the models are compared with.
void run_reference(PartRun& run);

}  // namespace springproof
