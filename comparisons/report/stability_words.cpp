#include "comparisons/report/headline_cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "comparisons/report/words.h"

namespace springproof {
namespace {

using namespace words;

// A smooth field has less: bending by two cells across 0.1, a body of whole cubes, whose corners stick out, up to 0.26.
// The wave of Golec et al. (2019), Figs. 3 and 6, alone has 0.8.
constexpr double wrinkled = 0.3;
// Neighbours of a wave of four cells are a quarter of a period apart; of shorter ones more (1 - cos k l > 1).
constexpr double short_wave = 1;

std::string change_words(double strain) {
  return fmt::format("{} by {} %", strain < 0 ? "shortened" : "lengthened", percent(std::abs(strain)));
}

std::string what_happens(const Stability& stability) {
  if (stability.lost == "inverted cell") return "a cell is turned inside out";
  if (stability.lost == "no convergence")
    return "Newton's method does not converge beyond it, which proves no loss of equilibrium";
  std::vector<std::string> axes;
  for (std::size_t axis = 0; axis < stability.alternation.size() && axis < 3; ++axis)
    if (stability.alternation[axis] > short_wave) axes.push_back(std::string(1, "xyz"[axis]));
  if (!axes.empty())
    return fmt::format(
        "the lattice wrinkles, neighbours move against each other along {}: the springs' failure, not the material's",
        listed(axes));
  return "it buckles or passes a limit point in a wave of more than four cells, as the material may";
}

bool moves(const std::string& model) { return model.ends_with(" in motion"); }

bool is_lost(const Run& run) { return run.stability && !run.stability->lost.empty(); }
bool is_wrinkled(const Run& run) { return run.stability && run.stability->wrinkles > wrinkled; }

/// Models of the case at rest that have a result at this Poisson's ratio and on these cells.
std::vector<std::string> holding(const CaseResult& result, const Run& of) {
  std::vector<std::string> names;
  for (const Run& run : result.runs)
    if (run.kind == "msm" && run.ok && !moves(run.model) && run.poisson_ratio == of.poisson_ratio &&
        run.cells == of.cells && !is_wrinkled(run) && std::ranges::find(names, run.model) == names.end())
      names.push_back(run.model);
  return names;
}

std::string advice(const CaseResult& result, const Run& run) {
  const std::vector<std::string> names = holding(result, run);
  if (names.empty()) {
    const bool tried = std::ranges::any_of(result.runs, [](const Run& r) { return r.model.starts_with("hybmss_avg"); });
    return std::string("no model of the case holds: apply less") + (tried ? "" : ", or take hybmss_avg");
  }
  return fmt::format("{} {} the whole load there", listed(names), names.size() == 1 ? "bears" : "bear");
}

std::string loss_words(const Experiment& e, const Run& run) {
  return fmt::format("{} at {} % of the load, {} % of strain", setting_text(e, run.poisson_ratio),
                     percent(run.stability->load_reached), percent(run.stability->strain));
}

}  // namespace

std::string limit_sentence(const Experiment& e, const LatticeLimit& limit) {
  std::vector<std::string> limits;
  const auto add = [&](const std::optional<double>& strain, const char* sides) {
    if (strain)
      limits.push_back(fmt::format("{} % with {} sides", *strain == 0 ? "0" : percent(std::abs(*strain)), sides));
  };
  add(limit.free, "free");
  add(limit.held, "held");
  return fmt::format(
      "{}: {} at {} may lose its equilibrium: it is to be {}, more in places, and its lattice without end is "
      "stable "
      "to {} ({}); {}",
      e.name, limit.model, setting_text(e, limit.poisson_ratio), change_words(limit.imposed), listed(limits),
      limit.wave, limit.instead.empty() ? "apply less" : limit.instead + " is stable there");
}

std::string stability_answer(const std::vector<CaseResult>& cases) {
  std::map<std::string, double> least;
  for (const CaseResult& result : cases) {
    if (std::ranges::none_of(result.runs, is_lost)) continue;
    double finest = 0;
    for (const Run& run : result.runs) finest = std::max(finest, cell_count(run.cells));
    for (const Run& run : result.runs) {
      if (run.kind != "msm" || moves(run.model) || cell_count(run.cells) < finest || !(run.ok || is_lost(run)))
        continue;
      const double share = run.ok ? 1 : run.stability->load_reached;
      const auto known = least.try_emplace(run.model, share).first;
      known->second = std::min(known->second, share);
    }
  }
  if (least.empty()) return "";
  std::vector<std::pair<std::string, double>> models(least.begin(), least.end());
  std::ranges::stable_sort(models, [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::string> parts;
  for (const auto& [model, share] : models)
    parts.push_back(fmt::format(
        "{} {}", model, share < 1 ? fmt::format("up to {} % of the load", percent(share)) : "under the whole load"));
  return fmt::format("In stable equilibrium, on the finest cells and at the worst Poisson's ratio: {}.",
                     fmt::join(parts, ", "));
}

std::vector<Warning> stability_warnings(const CaseResult& result, std::size_t case_number) {
  const std::string& name = result.experiment.name;
  // One warning per model and kind of loss, of the worst resolution and Poisson's ratio first.
  struct Group {
    std::vector<std::string> where;
    const Run* first = nullptr;
  };
  std::map<std::pair<std::string, std::string>, Group> lost, waves;
  std::vector<Warning> warnings;
  for (const Run& run : result.runs) {
    if (!is_lost(run) && !(is_wrinkled(run) && run.ok)) continue;
    Group& group = is_lost(run) ? lost[{run.model, what_happens(*run.stability)}] : waves[{run.model, ""}];
    if (!group.first) group.first = &run;
    group.where.push_back(is_lost(run) ? loss_words(result.experiment, run)
                                       : fmt::format("{} ({} % of the strain alternates)",
                                                     setting_text(result.experiment, run.poisson_ratio),
                                                     percent(run.stability->wrinkles)));
  }
  for (const auto& [key, group] : lost)
    warnings.push_back(
        {case_number,
         fmt::format("{}: {} {}, {}: {}", name, key.first,
                     group.first->stability->lost == "no convergence" ? "was not followed to the whole load"
                                                                      : "loses its equilibrium",
                     fmt::join(group.where, "; "), key.second),
         advice(result, *group.first)});
  for (const auto& [key, group] : waves) {
    const bool motion = moves(key.first);
    warnings.push_back(
        {case_number,
         fmt::format("{}: {} {}, {}: a wave of the lattice, not of the material", name, key.first,
                     motion ? "ripples from cell to cell" : "wrinkles from cell to cell", fmt::join(group.where, "; ")),
         motion ? "the motion is more sudden than its cells can carry (smaller cells, damping, a slower load), or the "
                  "lattice has no "
                  "face diagonals"
                : advice(result, *group.first)});
  }
  return warnings;
}

}  // namespace springproof
