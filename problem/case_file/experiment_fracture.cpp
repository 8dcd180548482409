#include <fmt/format.h>

#include "problem/case_file/experiment_parts.h"

namespace springproof {
namespace {

int as_count(const TomlValue& value, double most) {
  const std::string words = fmt::format("a whole number from 1 to {:g}", most);
  const double x = as_number(value, {words.c_str(), 1, most, true, true});
  if (x != static_cast<double>(static_cast<int>(x))) refuse(value, fmt::format("is {}", x), words);
  return static_cast<int>(x);
}

/// A drying body is held at rest and carries no load.
void check_supports(const Experiment& e) {
  for (std::size_t i = 0; i < e.loads.size(); ++i) {
    const auto* held = std::get_if<PrescribedDisplacement>(&e.loads[i]);
    const std::array<std::optional<double>, 3> at_rest = {0.0, 0.0, 0.0};
    if (!held || held->displacement != at_rest)
      throw InputError(e.load_locations[i],
                       "load: cannot act on a body that dries (allowed beside [fracture]: displacement_m = [0, 0, 0])");
  }
}

}  // namespace

void read_fracture(const TomlTable& document, Experiment& experiment) {
  const auto value = document.find("fracture");
  if (!value) return;
  const TomlTable table(*value, keys_of("fracture"));
  Fracture f;
  f.shrinkage = as_number(table.at("shrinkage"), {"a number from 0 to 0.5", 0, 0.5, true, true});
  f.threshold = as_number(table.at("threshold"), {"a number > 0, up to 1", 0, 1, false, true});
  if (const auto given = table.find("steps")) f.steps = as_count(*given, 1e5);
  if (const auto given = table.find("depth_m")) f.depth = as_number(*given, positive_number);
  if (const auto given = table.find("scatter"))
    f.scatter = as_number(*given, {"a number from 0 to 0.5", 0, 0.5, true, true});
  if (const auto given = table.find("apart")) f.apart = as_number(*given, not_negative);
  if (const auto given = table.find("seed")) f.seed = static_cast<std::uint64_t>(as_count(*given, 1e9));
  if (const auto given = table.find("seeds")) f.seeds = as_count(*given, 1000);
  // In a larger step all springs of an even body would reach their threshold at once.
  if (f.shrinkage / f.steps > f.threshold)
    refuse(table.at("shrinkage"),
           fmt::format("is {:.4g} in each of {} steps, beyond the threshold", f.shrinkage / f.steps, f.steps),
           fmt::format("shrinkage / steps up to the threshold, {:.4g}", f.threshold));
  if (experiment.kinematics != "linear")
    refuse(*value, fmt::format("does not go with kinematics = \"{}\"", experiment.kinematics), "\"linear\"");
  for (const char* other : {"reference", "line", "section", "probe"})
    if (const auto given = document.find(other))
      refuse(*given, "does not go with [fracture]", "no such table: springs alone break");
  check_supports(experiment);
  experiment.fracture = f;
  experiment.reference.elements.clear();
  experiment.elements.clear();
}

}  // namespace springproof
