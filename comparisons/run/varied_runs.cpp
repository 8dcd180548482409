#include "comparisons/run/varied_runs.h"

#include <fmt/format.h>

#include <algorithm>

#include "comparisons/results/records_json.h"
#include "comparisons/run/case_run.h"
#include "comparisons/run/expected_runs.h"
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

VariedRun run_of(const Experiment& e, const Variation& variation, const Experiment& changed) {
  VariedRun out{e.load_cases[variation.load_case].name, variation.input ? e.inputs[*variation.input].name : "", {}, ""};
  const Part part = run_part(prepare(changed), 0, {});
  for (const Row& row : part.rows)
    if (row.measure.starts_with("turn.") ||
        std::any_of(e.measured.begin(), e.measured.end(), [&](const auto& m) { return m.quantity == row.measure; }))
      out.rows.push_back(row);
  for (const Run& run : part.runs)
    if (!run.ok && out.message.empty()) out.message = run.model + ": " + run.message;
  return out;
}

/// All but the case as it is written.
std::vector<Variation> variations(const Experiment& e) {
  std::vector<Variation> all;
  if (e.measured.empty()) return all;
  for (std::size_t c = 0; c < e.load_cases.size(); ++c)
    for (std::size_t i = 0; i <= e.inputs.size(); ++i)
      if (c > 0 || i > 0) all.push_back({c, i > 0 ? std::optional(i - 1) : std::nullopt});
  return all;
}

RunCost cost_of(const Experiment& changed) {
  return {RunKind::of_variations, unmeshed_seconds(changed, changed.materials.front())};
}

}  // namespace

std::vector<VariedRun> varied_runs(const Experiment& e, const RunKeeper& keeper) {
  std::vector<VariedRun> runs;
  for (const Variation& variation : variations(e)) {
    if (children_interrupted()) return runs;
    const Experiment changed = case_of(e, variation);
    runs.push_back(keeper.run(
        fmt::format("load-case-{}-input-{}", variation.load_case, variation.input ? *variation.input + 1 : 0),
        cost_of(changed), [&] { return run_of(e, variation, changed); },
        [](const VariedRun& run) { return nlohmann::json(run); },
        [](const nlohmann::json& kept) { return kept.get<VariedRun>(); }));
  }
  return runs;
}

std::vector<RunCost> expected_variations(const Experiment& e) {
  std::vector<RunCost> runs;
  for (const Variation& variation : variations(e)) runs.push_back(cost_of(case_of(e, variation)));
  return runs;
}

}  // namespace springproof
