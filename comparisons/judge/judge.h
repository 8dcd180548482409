// Verdicts: compares the expectations of a case with the computed values.
#pragma once

#include <optional>
#include <string>

#include "comparisons/results/records.h"

namespace springproof {

/// The element of [reference] whose limit a name in [[expect]] denotes: "fem" the first, "fem_p1" linear tetrahedra;
/// nothing for a model, or for an element of [compare] beside models, which is run at their resolutions.
std::optional<std::string> reference_element(const Experiment& experiment, const std::string& model);

/// Judges the expectations and pairs published values with ours, once all parts are in result.rows.
void judge(CaseResult& result);

}  // namespace springproof
