// Checksum of what a case is computed from.
#pragma once

#include <string>

#include "comparisons/run/prepared_case.h"

namespace springproof {

/// Of the case file, the files of its body and the springs files of its models.
std::string input_checksum(const PreparedCase& prepared);

}  // namespace springproof
