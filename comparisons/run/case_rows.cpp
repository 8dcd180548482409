#include <cmath>
#include <set>

#include "comparisons/judge/measures.h"
#include "comparisons/reference/reference_grids.h"
#include "comparisons/run/part_run.h"
#include "problem/case_file/measures.h"

namespace springproof {
namespace {

/// Distances from the reference field [their units].
std::map<std::string, double> distances(const PartRun& run, std::size_t lattice, const NodalVectors& u) {
  const Mesh& mesh = run.mesh(lattice);
  const NodalVectors& v = run.reference[lattice]->field.displacement;
  const DisplacementScale& scale = run.reference[lattice]->scale;
  std::map<std::string, double> out = {{"displacement_error", weighted_norm(u - v, nodal_volumes(mesh)) / scale.mean},
                                       {"displacement_error_max", (u - v).rowwise().norm().maxCoeff() / scale.largest}};
  if (run.experiment().section) {
    out["section_distance"] = section_distance(mesh, *run.experiment().section, u, v);
    out["section_axis_distance"] = section_axis_distance(mesh, *run.experiment().section, u, v);
  }
  return out;
}

/// Mean and standard deviation of a measure over the samples that have it.
void set_value(const std::vector<std::map<std::string, double>>& samples, const std::string& measure, Row& row) {
  double sum = 0, squares = 0;
  row.samples = 0;
  for (const auto& sample : samples) {
    const auto at = sample.find(measure);
    if (at == sample.end()) continue;
    ++row.samples;
    sum += at->second;
    squares += at->second * at->second;
  }
  row.value = sum / row.samples;
  if (row.samples > 1) row.spread = std::sqrt(std::max(0.0, squares - sum * row.value) / (row.samples - 1));
}

std::set<std::string> measures_in(const std::vector<std::map<std::string, double>>& samples) {
  std::set<std::string> names;
  for (const auto& sample : samples)
    for (const auto& [measure, value] : sample) names.insert(measure);
  return names;
}

/// Distances from the reference, one of each measure for each sample, as rows whose best value is 0.
/// @param reaction that reaction_error is of
void add_distances(PartRun& run, const Row& blank, const std::vector<std::map<std::string, double>>& samples,
                   const std::map<std::string, double>& uncertainty, const std::string& reaction) {
  for (const std::string& measure : measures_in(samples)) {
    Row row = blank;
    set_value(samples, measure, row);
    row.reference = 0.0;
    row.reference_uncertainty = uncertainty.at(measure);
    row.error = row.value;
    if (measure == "reaction_error") row.of = reaction;
    add_row(run, row, measure);
  }
}

}  // namespace

Row blank_row(const PartRun& run, const RunKey& key, const std::string& kinematics) {
  Row row = of_run<Row>(key);
  row.case_name = run.experiment().name;
  row.kinematics = kinematics;
  return row;
}

void add_row(PartRun& run, Row row, const std::string& measure) {
  if (!wanted(measure, run.experiment().measures)) return;
  row.measure = measure;
  row.unit = unit_of(measure);
  run.part.rows.push_back(std::move(row));
}

void add_rows(PartRun& run, std::size_t lattice, const std::string& model, const std::string& kinematics,
              const std::vector<NodalVectors>& u, const std::vector<std::map<std::string, double>>& scalars) {
  const auto* reference = reference_at_rest(run, lattice, model);
  const Row blank = blank_row(run, run.key(model, lattice), kinematics);
  for (const std::string& measure : measures_in(scalars)) {
    Row row = blank;
    set_value(scalars, measure, row);
    if (is_deviation(measure)) row.error = row.value;
    if (reference && reference->scalars.contains(measure) && comparable(run.prepared, measure)) {
      const ReferenceValue& r = reference->scalars.at(measure);
      row.reference = r.value;
      row.reference_uncertainty = r.uncertainty;
      row.error = row.value - r.value;
    }
    add_row(run, row, measure);
  }
  if (!reference) return;
  // The nodal uncertainty of the reference, expressed in the same measures.
  NodalVectors doubt = reference->field.displacement;
  doubt.col(0) += reference->field.nodal_uncertainty;
  std::string of;  // the reaction that is off in the first sample
  const auto of_sample = [&](const NodalVectors& field, const std::map<std::string, double>& values) {
    std::map<std::string, double> out = distances(run, lattice, field);
    if (const auto reaction = reaction_error(run.prepared, values, reference->scalars)) {
      out["reaction_error"] = reaction->error;
      if (of.empty()) of = reaction->of;
    }
    return out;
  };
  std::vector<std::map<std::string, double>> of_samples;
  for (std::size_t s = 0; s < u.size(); ++s) of_samples.push_back(of_sample(u[s], scalars[s]));
  const std::map<std::string, double> uncertainty = of_sample(doubt, values_of(reference->scalars, 1));
  add_distances(run, blank, of_samples, uncertainty, of);
}

}  // namespace springproof
