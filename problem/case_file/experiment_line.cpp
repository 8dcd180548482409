#include <fmt/format.h>

#include <algorithm>

#include "problem/case_file/experiment_parts.h"

namespace springproof {
namespace {

/// The requirement of Kelvin's solution that a case does not meet; nullptr: none.
const char* missing_for_kelvin(const Experiment& experiment) {
  if (experiment.materials.size() != 1) return "one material";
  const auto forces = std::ranges::count_if(experiment.loads,
                                            [](const Load& load) { return std::holds_alternative<PointForce>(load); });
  if (forces != 1) return "exactly one point force, a [[load]] with force_N and at_m";
  return experiment.model_kinematics() == Kinematics::linear ? nullptr : "kinematics = \"linear\"";
}

}  // namespace

std::optional<KelvinSolution> kelvin_of(const Experiment& experiment) {
  if (missing_for_kelvin(experiment)) return {};
  for (const Load& load : experiment.loads)
    if (const auto* p = std::get_if<PointForce>(&load))
      return KelvinSolution{p->force, p->at, experiment.materials.front()};
  return {};
}

void settle_kelvin(Experiment& experiment) {
  for (std::size_t i = 0; i < experiment.loads.size(); ++i) {
    auto* load = std::get_if<PrescribedField>(&experiment.loads[i]);
    if (!load || load->field != "kelvin") continue;
    if (const char* missing = missing_for_kelvin(experiment))
      throw InputError(experiment.load_locations[i],
                       fmt::format("load.field: \"kelvin\" is not known here (needed: {})", missing));
    load->kelvin = kelvin_of(experiment);
  }
}

void read_line(const TomlTable& document, Experiment& experiment) {
  const auto value = document.find("line");
  if (!value) return;
  const TomlTable table(*value, keys_of("line"));
  Line line;
  line.from = as_vector(table.at("from_m"));
  line.to = as_vector(table.at("to_m"));
  if (line.from == line.to) refuse(table.at("to_m"), "is from_m", "another point");
  if (const auto points = table.find("points")) line.points = as_whole(*points, 2, 10000);
  if (const auto middle = table.find("middle")) {
    const auto items = as_list_of(2, *middle, "[first, last], numbers of points");
    for (int i = 0; i < 2; ++i) line.middle[i] = as_whole(items[i], i == 0 ? 1 : line.middle[0], line.points);
  } else {
    line.middle = {(15 * line.points + 99) / 100, 80 * line.points / 100};
  }
  if (const char* missing = missing_for_kelvin(experiment))
    refuse(*value, "is held against Kelvin's solution, which is not known here", missing);
  const Vec3 at = kelvin_of(experiment)->at;
  for (int i = 1; i <= line.points; ++i)
    if (point_of(line, i) == at)
      refuse(*value, fmt::format("has its point {} where the point force acts", i),
             "a line off it, or one that starts there");
  experiment.line = line;
}

Vec3 point_of(const Line& line, int number) { return line.from + double(number) / line.points * (line.to - line.from); }

}  // namespace springproof
