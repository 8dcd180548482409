// Displacements of another program, compared beside the models: [[external]] of a case file.
#pragma once

#include "problem/model_choice.h"

namespace springproof {

/// Name of such an entry among Experiment::models.  Its file holds points and displacements (docs/engines.md); options:
/// "poisson_ratio", whose solid they are of; "scale", which turns the file's lengths into metres; "up_axis", "y" or
/// "z"; "springs", false for what is only shown; "force.PATCH.x", "..y", "..z": reactions [N].
inline constexpr const char* external_model = "external displacements";

inline bool is_external(const ModelChoice& choice) { return choice.name == external_model; }

/// Whether such an entry is shown for comparison, as finite elements are, instead of being ranked: springs = false.
inline bool is_only_shown(const ModelChoice& choice) {
  const auto springs = choice.options.find("springs");
  return is_external(choice) && springs != choice.options.end() && !std::get<bool>(springs->second);
}

}  // namespace springproof
