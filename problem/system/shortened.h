// Messages of a length that is read.
#pragma once

#include <string>

namespace springproof {

/// Words of more than 100 letters by their beginning, "aaaa... (5000 letters)"; line breaks as spaces.
std::string shortened(const std::string& message);

}  // namespace springproof
