#include "comparisons/run/varied_runs.h"

#include <fmt/format.h>

#include <algorithm>

#include "comparisons/results/records_json.h"
#include "comparisons/run/case_run.h"
#include "comparisons/run/expected_runs.h"
#include "comparisons/run/prepare.h"
#include "problem/processes/child.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

VariedRun run_of(const Experiment& e, const Variation& variation, const Experiment& changed) {
  VariedRun out{e.load_cases[variation.load_case].name, variation.input ? e.inputs[*variation.input].name : "", {}, ""};
  Part part;
  try {
    part = run_part(prepare(changed), 0, {});
  } catch (const InputError& refused) {
    out.message = fmt::format("the case is refused: {}", refused.what());
  }
  for (const Row& row : part.rows)
    if (row.measure.starts_with("turn.") ||
        std::any_of(e.measured.begin(), e.measured.end(), [&](const auto& m) { return m.quantity == row.measure; }))
      out.rows.push_back(row);
  for (const Run& run : part.runs)
    if (!run.ok && out.message.empty()) out.message = run.model + ": " + run.message;
  return out;
}

}  // namespace

std::vector<VariedRun> varied_runs(const Experiment& e, const RunKeeper& keeper) {
  std::vector<VariedRun> runs;
  for (const Variation& variation : variations(e)) {
    if (children_interrupted()) return runs;
    const Experiment changed = case_of(e, variation);
    runs.push_back(keeper.run(
        fmt::format("load-case-{}-input-{}", variation.load_case, variation.input ? *variation.input + 1 : 0),
        cost_of_variation(changed), [&] { return run_of(e, variation, changed); },
        [](const VariedRun& run) { return nlohmann::json(run); },
        [](const nlohmann::json& kept) { return kept.get<VariedRun>(); }));
  }
  return runs;
}

}  // namespace springproof
