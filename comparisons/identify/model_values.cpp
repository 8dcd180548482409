#include "comparisons/identify/model_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <set>

#include "comparisons/judge/validation.h"
#include "comparisons/prepare/prepared_case.h"
#include "comparisons/results/records_json.h"
#include "comparisons/run/case_run.h"
#include "comparisons/run/prepare.h"
#include "fem_reference/exchange/reference.h"
#include "problem/case_file/measures.h"
#include "problem/files/files.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

bool is_element(const std::string& model) { return model.starts_with("fem_"); }

/// Keeps the i-th of a list that gives the resolutions, where it does.
template <class T>
void keep_number(std::size_t i, std::vector<T>& all) {
  if (i < all.size()) all = {all[i]};
}

/// The numbers of a body's resolutions, the coarsest first.
std::vector<std::size_t> by_fineness(const Body& body, std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  const auto sort_by = [&](const auto& of_each, auto coarser) {
    if (of_each.size() == count)
      std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return coarser(of_each[a], of_each[b]); });
  };
  sort_by(body.voxel_counts, std::less<>());
  sort_by(body.voxel_edges, std::greater<>());
  return order;
}

/// The measures that have the measured values.
std::vector<std::string> measures_of(const Experiment& e) {
  std::set<std::string> names;
  for (const MeasuredValue& m : e.measured) {
    names.insert(measure_of(m.quantity)->name);
    if (!m.arm.isZero(0)) names.insert("turn");
  }
  return {names.begin(), names.end()};
}

}  // namespace

ModelValues::ModelValues(const Experiment& e, const Identification& sought, std::filesystem::path folder)
    : experiment_(e),
      sought_(sought),
      folder_(std::move(folder)),
      stamp_(fmt::format("{} {} {}", SPRINGPROOF_VERSION, fem::version(), input_checksum(e))),
      lattices_(!sought.cells.empty()  ? sought.cells
                : e.body.cells.empty() ? std::vector<Cells>(e.body.resolutions(), Cells{0, 0, 0})
                                       : e.body.cells) {
  std::ranges::sort(lattices_, has_fewer_cells);
  resolution_ = by_fineness(e.body, lattices_.size());
}

std::vector<Cells> ModelValues::cells() const {
  std::vector<Cells> known;
  std::copy_if(lattices_.begin(), lattices_.end(), std::back_inserter(known), [](const Cells& c) { return c[0] > 0; });
  return known;
}

Experiment ModelValues::case_at(const Variation& variation, std::size_t lattice) const {
  Experiment changed = varied(experiment_, variation);
  changed.elements.clear();
  changed.measures = measures_of(experiment_);
  changed.dynamics.reset();
  if (is_element(sought_.model)) {
    changed.elements = {sought_.model.substr(4)};
    changed.reference = {.cells = {4, 4, 4}, .elements = {"q1"}};  // elements are run beside a reference alone
  } else {
    changed.reference.elements.clear();
    std::erase_if(changed.models, [&](const ModelChoice& m) { return m.label != sought_.model; });
  }
  changed.models.resize(1);
  if (!changed.body.is_voxels()) {
    changed.body.cells = {lattices_[lattice]};
    return changed;
  }
  keep_number(resolution_[lattice], changed.body.voxel_counts);
  keep_number(resolution_[lattice], changed.body.voxel_edges);
  keep_number(resolution_[lattice], changed.body.accuracies);
  return changed;
}

VariedRun ModelValues::made(const Experiment& changed, const std::string& load_case, const std::string& input) {
  VariedRun out{load_case, input, {}, ""};
  Part part;
  try {
    PreparedCase prepared = prepare(changed);
    if (is_element(sought_.model)) prepared.models.clear();  // the elements alone
    part = run_part(prepared, 0, {});
  } catch (const InputError& refused) {
    out.message = refused.what();
  }
  for (const Row& row : part.rows)
    if (row.model == sought_.model) out.rows.push_back(row);
  for (const Run& run : part.runs)
    if (run.model == sought_.model && !run.ok) out.message = run.message;
  if (out.rows.empty() && out.message.empty()) out.message = "no values of " + sought_.model;
  return out;
}

const VariedRun& ModelValues::run(const Numbers& numbers, std::size_t lattice, const Variation& variation) {
  const std::string load_case = experiment_.load_cases[variation.load_case].name,
                    input = variation.input ? experiment_.inputs[*variation.input].name : "";
  std::string key = fmt::format("{}|{}|{}|{}|{}", load_case, input, sought_.model, lattice,
                                experiment_.body.is_voxels() ? "" : cells_text(lattices_[lattice]));
  Variation changed = variation;
  for (std::size_t p = 0; p < numbers.size(); ++p) {
    changed.numbers.push_back({sought_.parameters[p].of, numbers[p]});
    for (const std::string& of : sought_.parameters[p].of) key += fmt::format("|{}={:.17g}", of, numbers[p]);
  }
  const std::string name = checksum(key);
  if (const auto known = runs_of_.find(name); known != runs_of_.end()) return known->second;
  progress::phase(fmt::format("{}, {}{} on {} cells", load_case, sought_.model, input.empty() ? "" : ", other " + input,
                              cells_text(lattices_[lattice], " x ")));
  const RunKeeper keeper(folder_, stamp_,
                         [this](const RunCost&, std::optional<double> took) { ++(took ? runs_ : kept_); });
  return runs_of_[name] = keeper.run(name, {}, [&] { return made(case_at(changed, lattice), load_case, input); });
}

std::vector<std::optional<double>> ModelValues::at(const Numbers& numbers, std::size_t lattice,
                                                   const std::vector<std::size_t>& wanted,
                                                   std::optional<std::size_t> input) {
  std::set<std::size_t> load_cases;
  for (const std::size_t m : wanted) {
    load_cases.insert(experiment_.measured[m].of);
    if (experiment_.measured[m].minus) load_cases.insert(*experiment_.measured[m].minus);
  }
  CaseResult result;
  result.experiment.load_cases = experiment_.load_cases;
  const std::string name = input ? experiment_.inputs[*input].name : "";
  for (const std::size_t c : load_cases) {
    result.varied.push_back(run(numbers, lattice, {c, input}));
    const VariedRun& made = result.varied.back();
    if (!made.message.empty()) message_ = made.message;
    if (!made.rows.empty()) lattices_[lattice] = made.rows.front().cells;
  }
  std::vector<std::optional<double>> values(experiment_.measured.size());
  for (const std::size_t m : wanted)
    values[m] = simulated(result, experiment_.measured[m], name, {sought_.model, lattices_[lattice]});
  return values;
}

}  // namespace springproof
