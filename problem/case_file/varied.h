// A case with another load case, or with one of its inputs changed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problem/case_file/experiment.h"

namespace springproof {

/// Numbers of the case that have one other value.
struct OtherNumber {
  std::vector<std::string> of;  ///< as written in the case: "body.size_m[2]"
  double value = 0;             ///< in the unit of their keys
};

/// One of the runs behind what is said of measured values.
struct Variation {
  std::size_t load_case = 0;              ///< 0: as written
  std::optional<std::size_t> input = {};  ///< changed by its uncertainty, or replaced by its alternative
  std::vector<OtherNumber> numbers = {};  ///< set before all else
};

/// @param path as in OtherNumber
/// @return the number in the case as it is written; empty: there is none
std::optional<double> number_of(const Experiment& experiment, const std::string& path);

/// The case as it would be read from a file with these changes, without what is measured, expected or printed.
/// Inputs that a load case does not have stay away.
/// @throws InputError as read_experiment, at the [[load_case]] or [[input]] for what the case cannot be changed to
Experiment varied(const Experiment& experiment, const Variation& variation);

}  // namespace springproof
