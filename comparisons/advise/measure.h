// Measures what advice is predicted from, and what it is held against, by `springproof compare`'s own code.
#pragma once

#include <filesystem>
#include <vector>

#include "comparisons/advise/measurement.h"
#include "problem/case_file/experiment.h"

namespace springproof {

/// The cases that were not used to make the predictions: built-in ones, and those in comparisons/advise/held_out, at
/// some of their Poisson's ratios.
std::vector<Experiment> held_out_cases();

/// The case in which a row of the measurements was measured.
/// @throws std::invalid_argument for a row of no such case.
Experiment measured_case(const Measurement& row);

/// Measures every model of advice in clamped blocks and round bars (docs/advise.md), or the held-out cases, a Poisson's
/// ratio at a time, and writes `file` after each; what is in `file` already is kept.
/// @return 0; 130 if interrupted.  @throws InputError if the file holds something else.
int measure(const std::filesystem::path& file, bool held_out);

}  // namespace springproof
