// How a case is made ready.
#pragma once

#include "comparisons/run/prepared_case.h"

namespace springproof {

/// @throws InputError for everything a user can get wrong, before any long work starts.
PreparedCase prepare(const Experiment& experiment);

}  // namespace springproof
