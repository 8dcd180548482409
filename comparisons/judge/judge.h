// Verdicts: what a case expects, held against what was computed.
#pragma once

#include <optional>
#include <string>

#include "comparisons/report/results.h"

namespace springproof {

/// The element of [reference] whose limit a name in [[expect]] stands for: "fem" the first, "fem_p1" linear tetrahedra;
/// nothing for a model, or for an element of [compare] beside models, which is run at their resolutions.
std::optional<std::string> reference_element(const Experiment& experiment, const std::string& model);

/// Judges the expectations and sets published values beside ours, once all parts are in result.rows.
void judge(CaseResult& result);

}  // namespace springproof
