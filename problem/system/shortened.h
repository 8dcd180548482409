// Shortens error messages.
#pragma once

#include <string>

namespace springproof {

/// The text without what colours it on a terminal (control sequences of ECMA-48), as libraries write it.
std::string without_colours(const std::string& text);

/// Cuts words of more than 100 letters to their beginning, "aaaa... (5000 letters)"; line breaks become spaces, colours
/// go.
std::string shortened(const std::string& message);

}  // namespace springproof
