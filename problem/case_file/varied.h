// A case with another load case, or with one of its inputs changed.
#pragma once

#include <optional>

#include "problem/case_file/experiment.h"

namespace springproof {

/// One of the runs behind what is said of measured values.
struct Variation {
  std::size_t load_case = 0;         ///< 0: as written
  std::optional<std::size_t> input;  ///< changed by its uncertainty, or replaced by its alternative
};

/// The case as it would be read from a file with these changes, without what is measured, expected or printed.
/// Inputs that a load case does not have stay away.
/// @throws InputError as read_experiment, at the [[load_case]] or [[input]] for what the case cannot be changed to
Experiment varied(const Experiment& experiment, const Variation& variation);

}  // namespace springproof
