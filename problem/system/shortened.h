// Shortens error messages.
#pragma once

#include <string>

namespace springproof {

/// Cuts words of more than 100 letters to their beginning, "aaaa... (5000 letters)"; line breaks become spaces.
std::string shortened(const std::string& message);

}  // namespace springproof
