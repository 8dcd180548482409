#include <fmt/format.h>

#include <algorithm>

#include "problem/case_file/experiment_parts.h"
#include "problem/case_file/measures.h"
#include "problem/exact_field.h"
#include "problem/files/file_name.h"

namespace springproof {
namespace {

bool is_fem(const std::string& model) {
  const auto elements = element_names();
  return model == "fem" ||
         (model.starts_with("fem_") && std::ranges::find(elements, model.substr(4)) != elements.end());
}

/// Names of the finite element results of a case.
std::vector<std::string> fem_names(const Experiment& experiment) {
  std::vector<std::string> names = {"fem"};
  const auto add = [&](const std::vector<std::string>& elements) {
    for (const std::string& element : elements)
      if (const std::string name = "fem_" + element; std::ranges::find(names, name) == names.end())
        names.push_back(name);
  };
  if (!experiment.models.empty()) add(experiment.elements);
  add(experiment.reference.elements);
  return names;
}

const std::vector<std::string> source_names = {"analytic", "extrapolated FEM", "published", "measured", "regression"};
const std::vector<std::string> default_measures = {"displacement_error", "volume_change", "reaction"};

std::string label_of(const ModelChoice& choice) {
  std::string label = choice.file.empty() ? choice.name : choice.file.stem().string();
  for (const auto& [name, value] : choice.options) {
    if (const bool* flag = std::get_if<bool>(&value); flag && *flag) {
      label += " " + name;
      continue;
    }
    const std::string shown = name == "face_to_cube" ? "A" : name;
    label += std::visit([&](const auto& v) { return fmt::format(" {}={}", shown, v); }, value);
  }
  return label;
}

std::variant<bool, double, std::string> read_option(const TomlValue& value) {
  if (const auto* flag = value.node->as_boolean()) return flag->get();
  if (value.node->is_string()) return as_text(value);
  return as_number(value, Range{"true or false, a finite number, or a string"});
}

ModelChoice read_model(const TomlValue& value) {
  ModelChoice choice;
  choice.where = location_of(value);
  const toml::table* table = value.node->as_table();
  if (!table) {
    choice.name = as_text(value);
  } else {
    // Options are checked by the table of models, so any key is accepted here.
    const toml::node *name = table->get("model"), *file = table->get("file");
    if (!name == !file)
      refuse({value.node, value.key + ".model", value.file}, name ? "stands beside file" : "is missing",
             "the name of a model, or file = \"a springs file\"");
    choice.name = as_text({name ? name : file, value.key + (name ? ".model" : ".file"), value.file});
    if (file) choice.file = std::filesystem::path(value.file).parent_path() / choice.name;
    for (const auto& [key, node] : *table) {
      const std::string option(key.str());
      const TomlValue option_value{&node, value.key + "." + option, value.file};
      if (option == "label")
        choice.label = as_text(option_value);
      else if (option != "model" && option != "file")
        choice.options[option] = read_option(option_value);
    }
  }
  if (choice.label.empty()) choice.label = label_of(choice);
  return choice;
}

/// Whether finite elements are run where there is no model: at rest by those that are named, or in time.
bool has_reference_alone(const TomlTable& document) {
  const auto reference = document.find("reference");
  const toml::table* table = reference ? reference->node->as_table() : nullptr;
  const toml::node* elements = table ? table->get("elements") : nullptr;
  return elements && (!elements->is_array() || !elements->as_array()->empty() || (*table)["in_time"].value_or(false));
}

/// An empty list means a case of the reference alone; [reference] must then name its elements.
std::vector<ModelChoice> read_models(const TomlValue& value, const TomlTable& document) {
  std::vector<ModelChoice> models;
  if (const auto* array = value.node->as_array(); array && array->empty()) {
    if (has_reference_alone(document) || document.find("external")) return models;
    refuse(value, "is an empty list",
           "model names, or none where [reference] has elements = [\"q2\", ...] or there is an [[external]]");
  }
  for (const TomlValue& item : as_list(value, "a list of model names and { model = \"...\" } tables")) {
    const ModelChoice choice = read_model(item);
    refuse_label(item, choice.label, models);
    models.push_back(choice);
  }
  return models;
}

/// Refuses a measure without what it needs.
void refuse_without(const TomlValue& item, const std::string& measure, const Experiment& e) {
  const bool large = e.model_kinematics() != Kinematics::linear,
             of_drying = measure == "fracture" || measure == "network";
  // clang-format off
  const struct { bool is_this, lacks; const char *what, *allowed; } needs[] = {
    {measure.starts_with("section_"), !e.section, "needs a plane", "with a [section] in the file"},
    {measure == "probe" || measure == "stress", e.probes.empty(), "needs points", "with at least one [[probe]] in the file"},
    {measure.starts_with("stress_"), large, "is of small strain", "with kinematics = \"linear\""},
    {measure == "displacement_error_order", e.exact.empty(), "needs the solution", "with exact = \"...\" in [compare]"},
    {measure == "reaction_error", moved_patches(e).empty(), "needs a support that is moved", "with a displacement or rotation other than zero"},
    {measure == "fracture", !e.fracture, "needs a body that dries", "with a [fracture] in the file"},
    {!of_drying, e.fracture.has_value(), "is not measured where a body dries", "fracture, network"},
    {measure == "motion", !e.dynamics, "needs one", "with [dynamics] in the file"},
    {measure == "motion_error", !e.reference.in_time, "needs finite elements in time", "with in_time = true in [reference]"},
    {measure == "line", !e.line, "needs one", "with a [line] in the file"},
    {measure == "moduli", !elongation_along_x(e), "needs a block stretched along x", "with a load that prescribes x on x_min and another on x_max"},
  };
  // clang-format on
  for (const auto& need : needs)
    if (need.is_this && need.lacks) refuse(item, fmt::format("'{}' {}", measure, need.what), need.allowed);
}

std::vector<std::string> read_measures(const TomlValue& value, const Experiment& experiment) {
  std::vector<std::string> measures;
  for (const TomlValue& item : as_list(value, "a list of measures")) {
    const std::string measure = as_choice(item, measure_names());
    if (std::ranges::find(measures, measure) != measures.end())
      refuse(item, fmt::format("'{}' is named twice", measure), "each measure once");
    refuse_without(item, measure, experiment);
    measures.push_back(measure);
  }
  return measures;
}

/// Whether it is a row of a measure of patches.  Whether the body has its patch is known only once it is meshed.
bool is_of_patch(const std::string& row) {
  const std::string patch = patch_of_row(row);
  const bool turn = row.starts_with("turn.");
  const auto components = {".x", ".y", ".z", ".magnitude"};
  return !patch.empty() && !(turn && row.ends_with(".magnitude")) &&
         std::ranges::any_of(components, [&](const char* c) { return row.ends_with(patch + c); });
}

}  // namespace

std::string read_row_name(const TomlValue& value, const Experiment& experiment) {
  if (const auto* text = value.node->as_string(); text && is_of_patch(text->get()))
    if (experiment.asks_for(measure_of(text->get())->name)) return text->get();
  std::vector<std::string> rows;
  for (const std::string& measure : experiment.measures)
    for (const std::string& row : rows_of_measure(measure, experiment)) rows.push_back(row);
  return as_choice(value, rows);
}

double as_number_of(const std::string& measure, TomlValue value, const Range& range) {
  value.in_si = unit_in(value.units, unit_of(measure)).in_si;
  return as_number(value, range);
}

namespace {

std::string read_judged_model(const TomlValue& value, const Experiment& experiment) {
  std::vector<std::string> labels;
  for (const ModelChoice& m : experiment.models) labels.push_back(m.label);
  if (experiment.body.is_voxels() && experiment.body.resolutions() > 1)
    for (const ModelChoice& m : experiment.models) labels.push_back(m.label + extrapolated_suffix);
  for (const std::string& name : fem_names(experiment)) labels.push_back(name);
  return as_choice(value, labels);
}

/// Resolution of a row.  A mass-spring model must be run at it; the reference has its own grids.
Cells read_row_cells(const TomlValue& value, const std::string& model, const Experiment& experiment) {
  const Cells cells = as_cells(value);
  const auto& known = experiment.body.cells;
  const bool not_known_yet = experiment.body.is_voxels();
  if (is_fem(model) || not_known_yet || std::ranges::find(known, cells) != known.end()) return cells;
  std::vector<std::string> allowed;
  for (const Cells& c : known) allowed.push_back(fmt::format("[{}]", fmt::join(c, ", ")));
  refuse(value, fmt::format("[{}] is not in the case", fmt::join(cells, ", ")),
         fmt::format("{}", fmt::join(allowed, ", ")));
}

void read_bound(const TomlTable& table, const TomlValue& bound, Expectation& expect) {
  expect.at_least = as_number_of(expect.measure, bound);
  for (const char* key : {"value", "within", "within_relative"})
    if (const auto other = table.find(key))
      refuse(*other, "stands beside at_least", "a value with a tolerance, or at_least");
}

void read_tolerance(const TomlTable& table, Expectation& expect) {
  const auto absolute = table.find("within"), relative = table.find("within_relative");
  if (absolute.has_value() == relative.has_value())
    refuse(table.value(), absolute ? "has two tolerances" : "has no tolerance",
           "exactly one of within, within_relative, at_least");
  expect.relative = relative.has_value();
  expect.within = relative ? as_number(*relative, not_negative) : as_number_of(expect.measure, *absolute, not_negative);
  if (relative && expect.value == 0.0)
    refuse(*relative, "is a fraction of a value that is 0", "within, the absolute tolerance");
}

Expectation read_expectation(const TomlValue& value, const Experiment& experiment) {
  const TomlTable table(value, keys_of("expect"));
  Expectation expect;
  expect.location = location_of(value);
  expect.model = read_judged_model(table.at("model"), experiment);
  if (const auto nu = table.find("poisson_ratio")) expect.poisson_ratio = read_poisson_ratio(*nu, experiment);
  if (const auto cells = table.find("cells")) expect.cells = read_row_cells(*cells, expect.model, experiment);
  expect.measure = read_row_name(table.at("measure"), experiment);
  expect.source = static_cast<Source>(as_choice_number(table.at("source"), source_names));
  if (expect.measure.starts_with("measured.") && expect.model != experiment.models.front().label)
    refuse(table.at("model"), fmt::format("'{}' is not judged by what was measured", expect.model),
           fmt::format("the first model, {}", experiment.models.front().label));
  if (expect.measure.starts_with("stress.") && !is_fem(expect.model) &&
      experiment.model_kinematics() != Kinematics::linear)
    refuse(table.at("measure"), fmt::format("'{}' is not known of '{}'", expect.measure, expect.model),
           "a stress of finite elements; of springs at small strain");
  if (const auto bound = table.find("at_least")) {
    read_bound(table, *bound, expect);
  } else {
    if (const auto number = table.find("value")) expect.value = as_number_of(expect.measure, *number);
    if (!expect.value && expect.source != Source::extrapolated_fem)
      missing(value, "value", "a finite number; only source = \"extrapolated FEM\" goes without");
    read_tolerance(table, expect);
  }
  if (const auto where = table.find("where")) expect.where = as_text(*where);
  return expect;
}

// Trilinear elements take about a second for so many cells, and ten times as long as springs: beside the models of
// larger lattices they run where the case asks for them.
constexpr double most_cells_with_elements = 20000;

/// Of the finest lattice, as far as the case file tells.
double most_cells(const Body& body) {
  double most = 0;
  for (const Cells& cells : body.cells) most = std::max(most, double(cells[0]) * cells[1] * cells[2]);
  for (const int voxels : body.voxel_counts) most = std::max(most, double(voxels));
  return most;
}

/// The models of a case with [dynamics]: each one's equilibrium, unless it is left out, and its motion, labelled
/// "NAME in motion".
std::vector<ModelChoice> with_motions(const std::vector<ModelChoice>& models, const MotionChoice& motion) {
  std::vector<ModelChoice> all;
  for (const ModelChoice& model : models) {
    if (motion.equilibrium) all.push_back(model);
    all.push_back(model);
    all.back().label += " in motion";
    all.back().in_motion = true;
  }
  return all;
}

void read_compare_table(const TomlValue& value, const TomlTable& document, Experiment& experiment) {
  const TomlTable table(value, keys_of("compare"));
  if (const auto models = table.find("models")) experiment.models = read_models(*models, document);
  if (const auto exact = table.find("exact")) {
    experiment.exact = as_choice(*exact, exact_field_names());
    if (!experiment.models.empty()) refuse(*exact, "stands beside models", "with models = []");
  }
  if (const auto measures = table.find("measures")) experiment.measures = read_measures(*measures, experiment);
  if (const auto elements = table.find("elements")) {
    if (experiment.fracture) refuse(*elements, "does not go with [fracture]", "no such key: springs alone break");
    experiment.elements = read_elements(*elements, element_names());
  }
  if (const auto most = table.find("max_unknowns")) experiment.max_unknowns = as_number(*most, positive_number);
  if (const auto cost = table.find("cost")) experiment.cost = as_flag(*cost);
  if (const auto parts = table.find("parts")) {
    experiment.parts = as_flag(*parts);
    if (experiment.parts && !experiment.body.is_voxels())
      refuse(*parts, "is for bodies that are cut out of a lattice", "voxels or voxel_edge_m in [body], or no such key");
    if (experiment.parts && experiment.cost)
      refuse(*parts, "does not go with cost = true", "one of the two: elements on refined cubes would be timed too");
  }
}

}  // namespace

std::string to_string(Source source) { return source_names[static_cast<std::size_t>(source)]; }

void refuse_label(const TomlValue& item, const std::string& label, const std::vector<ModelChoice>& others) {
  const bool unseen = std::ranges::any_of(label, [](unsigned char c) { return c < ' ' || c == 0x7f; });
  if (unseen || label.size() > longest_file_name)
    refuse(item, fmt::format("the label '{}' cannot name a file", label),
           fmt::format("up to {} letters, no control characters", longest_file_name));
  const std::string key = file_name_key(label);
  if (is_fem(key)) refuse(item, fmt::format("the label '{}' is taken", label), "a label of its own for each model");
  for (const ModelChoice& other : others) {
    if (file_name_key(other.label) != key) continue;
    const std::string same = other.label == label ? "" : fmt::format(" as the name of a file, by '{}'", other.label);
    refuse(item, fmt::format("the label '{}' is taken{}", label, same), "a label of its own for each model");
  }
}

double read_poisson_ratio(const TomlValue& value, const Experiment& experiment) {
  const double nu = as_number(value);
  const std::vector<double> known = experiment.settings();
  for (const double setting : known)
    if (same_poisson_ratio(setting, nu)) return setting;
  refuse(value, fmt::format("{} is not in the case", nu), fmt::format("{}", fmt::join(known, ", ")));
}

void read_compare(const TomlTable& document, Experiment& experiment) {
  experiment.models = {{"hybmss", {}, "hybmss", {experiment.file.string(), 0, 0}}};
  experiment.measures = experiment.fracture ? std::vector<std::string>{"fracture"} : default_measures;
  if (most_cells(experiment.body) > most_cells_with_elements) experiment.elements.clear();
  if (const auto value = document.find("compare")) read_compare_table(*value, document, experiment);
  if (experiment.dynamics) experiment.models = with_motions(experiment.models, *experiment.dynamics);
  read_externals(document, experiment);
  // Displacement errors alone are not enough for a body that is moved by its supports.
  if (!experiment.models.empty() && !moved_patches(experiment).empty() && !experiment.asks_for("reaction_error"))
    experiment.measures.emplace_back("reaction_error");
  if (!experiment.body.accuracies.empty() && !experiment.models.empty() && !experiment.asks_for("promised_error"))
    experiment.measures.emplace_back("promised_error");
  if (experiment.reference.in_time && !experiment.models.empty())
    for (const char* measure : {"motion", "motion_error"})
      if (!experiment.asks_for(measure)) experiment.measures.emplace_back(measure);
}

void read_expectations(const TomlTable& document, Experiment& experiment) {
  for (const TomlValue& value : document.tables("expect"))
    experiment.expectations.push_back(read_expectation(value, experiment));
}

void read_published(const TomlTable& document, Experiment& experiment) {
  for (const TomlValue& value : document.tables("published")) {
    const TomlTable table(value, keys_of("published"));
    PublishedValue printed;
    printed.location = location_of(value);
    printed.model = as_text(table.at("model"));
    printed.poisson_ratio = read_poisson_ratio(table.at("poisson_ratio"), experiment);
    if (const auto cells = table.find("cells")) printed.cells = as_cells(*cells);
    printed.measure = read_row_name(table.at("measure"), experiment);
    printed.value = as_number_of(printed.measure, table.at("value"));
    printed.where = as_text(table.at("where"));
    if (const auto remark = table.find("remark")) printed.remark = as_text(*remark);
    experiment.published.push_back(printed);
  }
}

}  // namespace springproof
