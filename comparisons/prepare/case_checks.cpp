#include "comparisons/prepare/case_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "comparisons/judge/judge.h"
#include "comparisons/judge/measures.h"
#include "problem/case_file/measures.h"
#include "problem/system/nearest_name.h"

namespace springproof {

void check_expectations(const Experiment& experiment) {
  for (const Expectation& e : experiment.expectations) {
    if (e.value || e.at_least) continue;
    if (reference_element(experiment, e.model))
      throw InputError(e.location, "value: an expectation of the reference itself needs one");
    if (e.relative && is_distance(e.measure))
      throw InputError(e.location,
                       fmt::format("within_relative: {} is expected to be 0; give an absolute `within`", e.measure));
  }
}

void check_kinematics(const Experiment& e, const std::vector<ModelParameters>& models) {
  if (e.model_kinematics() == Kinematics::linear) return;
  std::vector<std::string> able;
  for (const ModelRow& row : model_table())
    if (holds_at_large_displacement(row)) able.push_back(row.name);
  for (std::size_t m = 0; m < models.size(); ++m)
    if (const ModelRow& row = models[m].row; !holds_at_large_displacement(row))
      throw InputError(
          e.models[m].where,
          fmt::format(
              "compare.models: {} holds under kinematics = \"linear\" only, and the case has \"{}\" (allowed: {})",
              row.name, e.kinematics, fmt::join(able, ", ")));
}

void check_mean_displacements(const Experiment& e, const std::vector<std::string>& patches) {
  const auto check = [&](const std::string& row, const SourceLocation& where) {
    const std::string patch = patch_of_mean_displacement(row);
    if (patch.empty() || std::find(patches.begin(), patches.end(), patch) != patches.end()) return;
    throw InputError(where, fmt::format("measure: the body has no patch '{}' (allowed: {}){}", patch,
                                        fmt::join(patches, ", "), did_you_mean(patch, patches)));
  };
  for (const Expectation& x : e.expectations) check(x.measure, x.location);
  for (const PublishedValue& v : e.published) check(v.measure, v.location);
}

}  // namespace springproof
