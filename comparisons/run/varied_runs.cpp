#include "comparisons/run/varied_runs.h"

#include <algorithm>

#include "comparisons/run/case_run.h"
#include "comparisons/run/prepare.h"
#include "problem/case_file/varied.h"
#include "problem/processes/child.h"

namespace springproof {
namespace {

template <class T>
void keep_first(std::vector<T>& all) {
  if (all.size() > 1) all.resize(1);
}

/// The case of a variation, without what is not measured.
Experiment case_of(const Experiment& e, const Variation& variation) {
  Experiment changed = varied(e, variation);
  keep_first(changed.models);
  if (!variation.input) return changed;
  changed.elements.clear();
  changed.reference.elements.clear();
  for (auto* numbers : {&changed.body.voxel_edges, &changed.body.accuracies}) keep_first(*numbers);
  keep_first(changed.body.voxel_counts);
  keep_first(changed.body.cells);
  return changed;
}

VariedRun run_of(const Experiment& e, const Variation& variation) {
  VariedRun out{e.load_cases[variation.load_case].name, variation.input ? e.inputs[*variation.input].name : "", {}, ""};
  const Experiment changed = case_of(e, variation);
  const Part part = run_part(prepare(changed), 0, {});
  for (const Row& row : part.rows)
    if (row.measure.starts_with("turn.") ||
        std::any_of(e.measured.begin(), e.measured.end(), [&](const auto& m) { return m.quantity == row.measure; }))
      out.rows.push_back(row);
  for (const Run& run : part.runs)
    if (!run.ok && out.message.empty()) out.message = run.model + ": " + run.message;
  return out;
}

}  // namespace

std::vector<VariedRun> varied_runs(const Experiment& e) {
  std::vector<VariedRun> runs;
  if (e.measured.empty()) return runs;
  for (std::size_t c = 0; c < e.load_cases.size(); ++c)
    for (std::size_t i = 0; i <= e.inputs.size(); ++i) {
      if (children_interrupted()) return runs;
      const Variation variation{c, i > 0 ? std::optional(i - 1) : std::nullopt};
      if (c > 0 || i > 0) runs.push_back(run_of(e, variation));
    }
  return runs;
}

}  // namespace springproof
