// Checksum of what a case is computed from.
#pragma once

#include <string>

#include "problem/case_file/experiment.h"

namespace springproof {

/// Of the case file, the files of its body and the springs files of its models.
/// @throws InputError if there is no such body.
std::string input_checksum(const Experiment& experiment);

}  // namespace springproof
