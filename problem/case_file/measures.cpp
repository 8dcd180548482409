#include "problem/case_file/measures.h"

#include <algorithm>
#include <set>

#include "problem/case_file/experiment.h"

namespace springproof {
namespace {

void add_vector_rows(const std::string& prefix, std::vector<std::string>& rows) {
  for (const char* component : {".x", ".y", ".z", ".magnitude"}) rows.push_back(prefix + component);
}

const std::string mean_displacement = "mean_displacement.";

/// Whether the load prescribes a displacement other than zero.
bool moves(const Load& load) {
  if (const auto* p = std::get_if<PrescribedDisplacement>(&load))
    return std::any_of(p->displacement.begin(), p->displacement.end(),
                       [](const auto& u) { return u.value_or(0) != 0; });
  if (const auto* a = std::get_if<PrescribedAffine>(&load)) return !a->gradient.isZero(0) || !a->offset.isZero(0);
  if (const auto* r = std::get_if<PrescribedRotation>(&load)) return r->angle != 0;
  return std::holds_alternative<PrescribedField>(load);
}

/// Patches of the loads that do this, in the file's order, each once.
std::vector<std::string> patches_of(const Experiment& experiment, bool (*does)(const Load&)) {
  std::vector<std::string> patches;
  for (const Load& load : experiment.loads) {
    if (!does(load)) continue;
    const std::string& patch = *patch_of(load);
    if (std::find(patches.begin(), patches.end(), patch) == patches.end()) patches.push_back(patch);
  }
  return patches;
}

std::vector<std::string> reaction_rows(const Experiment& experiment) {
  std::vector<std::string> rows;
  for (const std::string& patch : supported_patches(experiment)) {
    add_vector_rows("force." + patch, rows);
    add_vector_rows("torque." + patch, rows);
  }
  return rows;
}

/// Those whose names the case file holds.
std::vector<std::string> mean_displacement_rows(const Experiment& experiment) {
  std::set<std::string> patches;
  for (const Load& load : experiment.loads)
    if (const std::string* on = patch_of(load)) patches.insert(*on);
  for (const PatchRule& rule : experiment.patches) patches.insert(rule.name);
  std::vector<std::string> rows;
  for (const std::string& patch : patches) add_vector_rows(mean_displacement + patch, rows);
  return rows;
}

std::vector<std::string> probe_rows(const Experiment& experiment) {
  std::vector<std::string> rows;
  for (const Probe& probe : experiment.probes) add_vector_rows("displacement." + probe.name, rows);
  return rows;
}

std::vector<std::string> stress_rows(const Experiment& experiment) {
  std::vector<std::string> rows;
  for (const Probe& probe : experiment.probes)
    for (const char* component : {".xx", ".yy", ".zz", ".xy", ".yz", ".xz"})
      rows.push_back("stress." + probe.name + component);
  return rows;
}

std::vector<std::string> network_rows(const Experiment&) {
  return {"network.nodes", "network.springs", "network.springs_per_node", "network.mean_length",
          "network.length_deviation"};
}

std::vector<std::string> moduli_rows(const Experiment&) {
  return {"moduli.youngs_modulus",          "moduli.youngs_modulus_local",     "moduli.poisson_ratio",
          "moduli.poisson_ratio_of_fields", "moduli.poisson_ratio_as_printed", "moduli.affine_youngs_modulus"};
}

std::vector<std::string> line_rows(const Experiment& experiment) {
  std::vector<std::string> rows;
  for (const std::string field : {"line.strain", "line.stress"}) {
    for (const char* component : {".xx", ".yy", ".zz", ".xy", ".yz", ".xz", ".all"}) rows.push_back(field + component);
    if (experiment.body.resolutions() > 1) rows.push_back(field + ".order");
  }
  return rows;
}

struct Measure {
  const char* name;
  std::vector<std::string> (*rows)(const Experiment&);  ///< nullptr: one row of the same name
};

constexpr Measure measures[] = {
    {"displacement_error", nullptr},
    {"displacement_error_max", nullptr},
    {"section_distance", nullptr},
    {"section_axis_distance", nullptr},
    {"volume_change", nullptr},
    {"volume_change_magnitude", nullptr},
    {"volume_change_first_order", nullptr},
    {"reaction", reaction_rows},
    {"reaction_error", nullptr},
    {"mean_displacement", mean_displacement_rows},
    {"probe", probe_rows},
    {"stress", stress_rows},
    {"displacement_error_order", nullptr},
    {"network", network_rows},
    {"moduli", moduli_rows},
    {"line", line_rows},
};

}  // namespace

std::vector<std::string> measure_names() {
  std::vector<std::string> names;
  for (const Measure& measure : measures) names.emplace_back(measure.name);
  return names;
}

std::vector<std::string> rows_of_measure(const std::string& name, const Experiment& experiment) {
  for (const Measure& measure : measures)
    if (name == measure.name && measure.rows) return measure.rows(experiment);
  return {name};
}

std::optional<double> elongation_along_x(const Experiment& experiment) {
  std::optional<double> low, high;
  for (const Load& load : experiment.loads)
    if (const auto* p = std::get_if<PrescribedDisplacement>(&load)) {
      if (p->on == "x_min") low = p->displacement[0];
      if (p->on == "x_max") high = p->displacement[0];
    }
  if (!low || !high || *low == *high) return {};
  return *high - *low;
}

std::vector<std::string> supported_patches(const Experiment& experiment) {
  return patches_of(experiment, prescribes_displacement);
}

std::vector<std::string> moved_patches(const Experiment& experiment) { return patches_of(experiment, moves); }

std::string patch_of_mean_displacement(const std::string& row) {
  if (!row.starts_with(mean_displacement)) return "";
  return row.substr(mean_displacement.size(), row.rfind('.') - mean_displacement.size());
}

}  // namespace springproof
