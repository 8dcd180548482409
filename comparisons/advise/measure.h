// Measures what predictions are held against, by `springproof compare`'s own code.
#pragma once

#include <filesystem>
#include <vector>

#include "comparisons/advise/measurement.h"
#include "problem/case_file/experiment.h"

namespace springproof {

/// The cases that were not used to make the predictions: built-in ones, and those in comparisons/advise/held_out, at
/// some of their Poisson's ratios; blocks with the finite elements q1 and q2 beside the models.
std::vector<Experiment> held_out_cases();

/// Measures every model of advice in the held-out cases, a Poisson's ratio at a time, and writes `file` after each;
/// what is in `file` already is kept.
/// @return 0; 130 if interrupted.  @throws InputError if the file holds something else.
int measure_held_out(const std::filesystem::path& file);

}  // namespace springproof
