#include <fmt/format.h>
#include <fmt/ranges.h>

#include "problem/case_file/experiment_parts.h"
#include "problem/case_file/external.h"

namespace springproof {
namespace {

constexpr Key external_schema[] = {{"name", "a name for its results"},
                                   {"file", "the name of a CSV file of points and displacements"},
                                   {"poisson_ratio"},
                                   {"scale"},
                                   {"up_axis"},
                                   {"reaction_N"}};

/// One vector of each patch, as options.
void read_reactions(const TomlValue& value, ModelChoice& choice) {
  const toml::table* patches = value.node->as_table();
  if (!patches || patches->empty())
    refuse(value, "is no table of patches", "{ x_min = [x, y, z] }, the force of each support on the body [N]");
  for (const auto& [key, node] : *patches) {
    const std::string patch(key.str());
    const Vec3 force = as_vector({&node, value.key + "." + patch, value.file});
    for (int d = 0; d < 3; ++d) choice.options["force." + patch + "." + "xyz"[d]] = force[d];
  }
}

ModelChoice read_external(const TomlValue& value, const Experiment& experiment) {
  const TomlTable table(value, external_schema);
  ModelChoice choice;
  choice.where = location_of(value);
  choice.name = external_model;
  choice.label = as_text(table.at("name"));
  choice.file = std::filesystem::path(value.file).parent_path() / as_text(table.at("file"));
  if (const auto nu = table.find("poisson_ratio"))
    choice.options["poisson_ratio"] = read_poisson_ratio(*nu, experiment);
  else if (experiment.materials.size() == 1)
    choice.options["poisson_ratio"] = experiment.materials.front().poisson_ratio;
  else
    refuse({value.node, value.key + ".poisson_ratio", value.file},
           fmt::format("is missing, and the case has {}", experiment.materials.size()),
           "the Poisson's ratio of the solid whose displacements these are");
  if (const auto scale = table.find("scale")) choice.options["scale"] = as_number(*scale, positive_number);
  if (const auto up = table.find("up_axis")) choice.options["up_axis"] = as_choice(*up, {"y", "z"});
  if (const auto reactions = table.find("reaction_N")) read_reactions(*reactions, choice);
  return choice;
}

}  // namespace

void read_externals(const TomlTable& document, Experiment& experiment) {
  for (const TomlValue& value : document.tables("external")) {
    if (experiment.fracture) refuse(value, "does not go with [fracture]", "no such table: springs alone break");
    if (experiment.cost) refuse(value, "does not go with cost = true", "no such table: its run time is not known");
    if (!experiment.exact.empty()) refuse(value, "does not go with exact", "no such table, or no exact solution");
    const ModelChoice choice = read_external(value, experiment);
    refuse_label(value, choice.label, experiment.models);
    experiment.models.push_back(choice);
  }
}

}  // namespace springproof
