// Displacements of another program, compared beside the models: [[external]] of a case file.
#pragma once

#include "problem/model_choice.h"

namespace springproof {

/// Name of such an entry among Experiment::models: one for each file, so of several Poisson's ratios several of one
/// label.  Its file holds points and displacements (docs/engines.md); options: "poisson_ratio", whose solid they are
/// of; "scale", which turns the file's lengths into metres; "up_axis", "y" or "z"; "force.PATCH.x", "..y", "..z":
/// reactions [N]; "springs", false where they are no spring model's.
inline constexpr const char* external_model = "external displacements";

inline bool is_external(const ModelChoice& choice) { return choice.name == external_model; }

/// Whether the entry is a spring model of the user's own, to be named and ranked as one; false: finite elements or an
/// engine, brought for comparison only (springs = false).
inline bool is_own_model(const ModelChoice& choice) {
  const auto springs = choice.options.find("springs");
  return is_external(choice) && (springs == choice.options.end() || std::get<bool>(springs->second));
}

}  // namespace springproof
