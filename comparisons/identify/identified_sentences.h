// What is said of an identification.
#pragma once

#include <string>
#include <vector>

#include "comparisons/identify/identified.h"

namespace springproof {

/// What the values do not tell, what the limits leave out, whether the values agree, and how many predictions hold.
std::vector<std::string> sentences_of(const Identified& identified);

}  // namespace springproof
