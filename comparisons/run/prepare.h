// Prepares a case for its runs.
#pragma once

#include "comparisons/run/prepared_case.h"

namespace springproof {

/// @throws InputError for every error in the input, before any long work starts.
PreparedCase prepare(const Experiment& experiment);

}  // namespace springproof
