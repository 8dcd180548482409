// The variations of a case with measured values: its other load cases, and each with the inputs changed one by one.
#pragma once

#include <vector>

#include "problem/case_file/varied.h"

namespace springproof {

/// All but the case as it is written; none of a case without measured values.
std::vector<Variation> variations(const Experiment& experiment);

/// The case of a variation, without what is not measured: its first model, with an input changed on the lattice
/// of fewest cells alone and without finite elements.
Experiment case_of(const Experiment& experiment, const Variation& variation);

}  // namespace springproof
