// Reduces error messages of libraries to one sentence.
#pragma once

#include <string>

namespace springproof::fem {

/// deal.II's exceptions print location, signature, condition and stack.  Returns their additional information, else the
/// violated condition; other messages as they are.  White space and rulers become single spaces.
std::string plain_words(const std::string& message);

}  // namespace springproof::fem
