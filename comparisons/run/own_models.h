// Springs files among the models of a case.
#pragma once

#include "comparisons/prepare/prepared_case.h"

namespace springproof {

/// @throws InputError at a springs file that stands for other materials than the case's.
void check_own_models(const PreparedCase& prepared);

/// Once the body is meshed.
/// @throws InputError at a springs file whose regions are of another size or place than the case's.
void check_own_regions(const PreparedCase& prepared);

}  // namespace springproof
