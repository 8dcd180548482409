#include "comparisons/judge/judge.h"

#include <algorithm>
#include <cmath>

namespace springproof {
namespace {

// Largest uncertainty of a reference, as a fraction of the tolerance that it is used for.
constexpr double largest_uncertainty_fraction = 0.25;

const Row* find_row(const CaseResult& result, const RunKey& key, const std::string& measure) {
  for (const Row& row : result.rows)
    if (same_run(row, key) && row.measure == measure) return &row;
  return nullptr;
}

const ReferenceRecord* find_reference(const CaseResult& result, const std::string& element, double nu,
                                      const std::string& measure) {
  for (const ReferenceRecord& r : result.references)
    if (r.element == element && same_poisson_ratio(r.poisson_ratio, nu) && r.measure == measure) return &r;
  return nullptr;
}

void decide(const Expectation& e, bool any_reference, Check& check) {
  const bool by_fem = e.source == Source::extrapolated_fem;
  if (check.computed && e.at_least)
    check.verdict = *check.computed >= *e.at_least ? Verdict::pass : Verdict::fail;
  else if (!check.computed)
    check.verdict = is_distance(e.measure) && !any_reference ? Verdict::no_reference : Verdict::no_result;
  else if (by_fem && !check.reference_uncertainty)
    check.verdict = Verdict::no_reference;
  else {
    const double miss = std::abs(*check.computed - check.expected), doubt = check.reference_uncertainty.value_or(0);
    if (miss > check.within + doubt)
      check.verdict = Verdict::fail;
    else if (doubt > largest_uncertainty_fraction * check.within)
      check.verdict = Verdict::reference_too_coarse;
    else
      check.verdict = miss <= check.within ? Verdict::pass : Verdict::fail;
  }
}

Check judge_one(const CaseResult& result, const Expectation& e, const RunKey& key) {
  Check check = of_run<Check>(key);
  check.measure = e.measure;
  check.unit = unit_of(e.measure);
  check.source = to_string(e.source);
  check.expected = e.at_least ? *e.at_least : e.value.value_or(0);
  check.where = e.where;
  check.at_least = e.at_least.has_value();
  if (const auto element = reference_element(result.experiment, e.model)) {
    if (const ReferenceRecord* r = find_reference(result, *element, key.poisson_ratio, e.measure)) {
      check.computed = r->value;
      check.reference_uncertainty = r->uncertainty;
    }
  } else if (const Row* row = find_row(result, key, e.measure)) {
    check.computed = row->value;
    if (e.source == Source::extrapolated_fem || is_distance(e.measure)) {
      check.reference_uncertainty = row->reference_uncertainty;
      if (!e.value) check.expected = row->reference.value_or(0);
    }
  }
  check.within = e.relative ? e.within * std::abs(check.expected) : e.within;
  const bool any_reference = std::ranges::any_of(result.references, [&](const ReferenceRecord& r) {
    return same_poisson_ratio(r.poisson_ratio, key.poisson_ratio);
  });
  decide(e, any_reference, check);
  return check;
}

/// Displacements of another program are of one Poisson's ratio, and compared at one resolution.
bool left_out(const CaseResult& result, const RunKey& key) {
  const auto runs_there = [&](bool here) {
    return std::ranges::any_of(result.runs, [&](const Run& run) {
      return run.kind == "external" && run.model == key.model && (!here || same_run(run, key));
    });
  };
  return runs_there(false) && !runs_there(true);
}

}  // namespace

std::optional<std::string> reference_element(const Experiment& experiment, const std::string& model) {
  const std::vector<std::string>& elements = experiment.reference.elements;
  if (model == "fem" && !elements.empty()) return elements.front();
  if (!experiment.models.empty())
    for (const std::string& peer : experiment.elements)
      if (model == "fem_" + peer) return {};
  for (const std::string& element : elements)
    if (model == "fem_" + element) return element;
  return {};
}

void judge(CaseResult& result) {
  const Experiment& experiment = result.experiment;
  for (const Expectation& e : experiment.expectations)
    for (const double setting : experiment.settings()) {
      if (e.poisson_ratio && !same_poisson_ratio(*e.poisson_ratio, setting)) continue;
      const bool once = reference_element(experiment, e.model) || e.measure.starts_with("measured.");
      const std::vector<Cells> everywhere = once      ? std::vector<Cells>{result.cells.front()}
                                            : e.cells ? std::vector<Cells>{*e.cells}
                                                      : result.cells;
      for (const Cells& cells : everywhere)
        if (const RunKey key{e.model, setting, cells}; !left_out(result, key))
          result.checks.push_back(judge_one(result, e, key));
    }
  for (const PublishedValue& p : experiment.published) {
    const RunKey key = {p.model, p.poisson_ratio, p.cells.value_or(result.cells.front())};
    PublishedRow row{key, p.measure, unit_of(p.measure), p.value, {}, p.where, p.remark};
    const Row* ours = find_row(result, key, p.measure);
    if (ours) row.computed = ours->value;
    if (const auto element = reference_element(experiment, p.model))
      if (const ReferenceRecord* r = find_reference(result, *element, p.poisson_ratio, p.measure))
        row.computed = r->value;
    result.published.push_back(row);
  }
}

}  // namespace springproof
