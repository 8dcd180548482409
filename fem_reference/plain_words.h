// Messages of libraries as one sentence.
#pragma once

#include <string>

namespace springproof::fem {

/// deal.II's exceptions print pages: place, signature, condition, stack.  What they have to say, else the text itself,
/// white space and rulers as single spaces.
std::string plain_words(const std::string& message);

}  // namespace springproof::fem
