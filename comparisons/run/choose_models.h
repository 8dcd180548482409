// The models of a case: what each is built of, and what the case cannot have them do.
#pragma once

#include "comparisons/prepare/prepared_case.h"

namespace springproof {

/// Sets PreparedCase::models, before the body is meshed.
/// @throws InputError at a model that does not suit the case, as a springs file of other materials.
void choose_models(PreparedCase& prepared);

/// Once the body is meshed.
/// @throws InputError at a springs file whose regions are of another size or place than the case's.
void check_own_regions(const PreparedCase& prepared);

}  // namespace springproof
