#include <fmt/format.h>
#include <fmt/ranges.h>

#include "problem/case_file/experiment_parts.h"

namespace springproof {
namespace {

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

/// `of`: the table that has the keys of the file.
ModelChoice read_file(const TomlTable& of, ModelChoice choice, const Experiment& experiment) {
  const TomlValue& value = of.value();
  choice.where = location_of(value);
  choice.file = std::filesystem::path(value.file).parent_path() / as_text(of.at("file"));
  if (const auto nu = of.find("poisson_ratio"))
    choice.options["poisson_ratio"] = read_poisson_ratio(*nu, experiment);
  else if (const std::vector<double> settings = experiment.settings(); settings.size() == 1)
    choice.options["poisson_ratio"] = settings.front();
  else
    refuse({value.node, value.key + ".poisson_ratio", value.file},
           fmt::format("is missing, and the case has {}", settings.size()),
           "the Poisson's ratio of the solid whose displacements these are");
  if (const auto reactions = of.find("reaction_N")) read_reactions(*reactions, choice);
  return choice;
}

/// One entry for each file.
std::vector<ModelChoice> read_external(const TomlValue& value, const Experiment& experiment) {
  const TomlTable table(value, keys_of("external"));
  ModelChoice choice;
  choice.name = external_model;
  choice.label = as_text(table.at("name"));
  const double unit = unit_in(value.units, "m").in_si;
  if (const auto scale = table.find("scale"))
    choice.options["scale"] = unit * as_number(*scale, positive_number);
  else if (unit != 1)
    choice.options["scale"] = unit;
  if (const auto up = table.find("up_axis")) choice.options["up_axis"] = as_choice(*up, {"y", "z"});
  if (const auto springs = table.find("springs")) choice.options["springs"] = as_flag(*springs);
  const auto files = table.find("files");
  if (!files && !table.find("file"))
    missing(value, "file",
            "the name of a CSV file of points and displacements, or files = [{ poisson_ratio = 0.3, file = \"...\" }]");
  if (!files) return {read_file(table, choice, experiment)};
  for (const Key& key : keys_of("external.files"))
    if (const auto beside = table.find(key.name)) refuse(*beside, "stands beside files", "in the rows of files");
  std::vector<ModelChoice> of_files;
  for (const TomlValue& item : as_list(*files, "a list of { poisson_ratio = 0.3, file = \"...\" }"))
    of_files.push_back(read_file(TomlTable(item, keys_of("external.files")), choice, experiment));
  return of_files;
}

/// Adds an entry: a label of its own, or that of the same program's files at other Poisson's ratios.
void add_external(const TomlValue& value, const ModelChoice& choice, std::vector<ModelChoice>& models) {
  std::vector<ModelChoice> rivals = models;
  std::erase_if(rivals, [&](const ModelChoice& m) { return is_external(m) && m.label == choice.label; });
  refuse_label(value, choice.label, rivals);
  for (const ModelChoice& m : models) {
    if (m.label != choice.label) continue;
    if (m.options.at("poisson_ratio") == choice.options.at("poisson_ratio"))
      throw InputError(
          choice.where,
          fmt::format("external.name: the label '{}' has a file at nu = {:g} already (allowed: one file of "
                      "each Poisson's ratio, or a label of its own)",
                      choice.label, std::get<double>(choice.options.at("poisson_ratio"))));
    if (is_own_model(m) != is_own_model(choice))
      refuse(value, fmt::format("the label '{}' is of springs at one Poisson's ratio and not at another", choice.label),
             "springs = false at all of them, or a label of its own");
  }
  models.push_back(choice);
}

}  // namespace

void read_externals(const TomlTable& document, Experiment& experiment) {
  for (const TomlValue& value : document.tables("external")) {
    if (experiment.fracture) refuse(value, "does not go with [fracture]", "no such table: springs alone break");
    if (experiment.cost) refuse(value, "does not go with cost = true", "no such table: its run time is not known");
    if (!experiment.exact.empty()) refuse(value, "does not go with exact", "no such table, or no exact solution");
    for (const ModelChoice& choice : read_external(value, experiment)) add_external(value, choice, experiment.models);
  }
}

}  // namespace springproof
