#include "comparisons/report/model_errors.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>

#include "comparisons/report/headline_words.h"
#include "comparisons/report/results.h"

namespace springproof {

namespace {
using namespace words;
}  // namespace

std::string range_text(double from, double to) {
  return from == to ? fmt::format("at ν = {}", nu_text(from))
                    : fmt::format("for ν from {} to {}", nu_text(from), nu_text(to));
}

std::string range_text(const ByNu& errors) { return range_text(errors.begin()->first, errors.rbegin()->first); }

const std::pair<const double, Worst>& largest(const ByNu& errors) {
  return *std::max_element(errors.begin(), errors.end(),
                           [](const auto& a, const auto& b) { return a.second.error < b.second.error; });
}

ByNu claimed(const ModelErrors& errors, const ByNu& by_nu) {
  ByNu out = by_nu;
  if (errors.own_nu)
    std::erase_if(out, [&](const auto& entry) { return !same_poisson_ratio(entry.first, *errors.own_nu); });
  return out;
}

namespace {

/// Those by which the closest model is found: without the auxetic ones, where there are others.
ByNu ranked(const ModelErrors& errors, const ByNu& by_nu) {
  ByNu all = claimed(errors, by_nu), ordinary = all;
  std::erase_if(ordinary, [](const auto& entry) { return entry.first < 0; });
  return ordinary.empty() ? all : ordinary;
}

std::string auxetic_clause(const ModelErrors& errors) {
  ByNu auxetic = claimed(errors, errors.rank);
  if (auxetic.empty() || auxetic.rbegin()->first < 0) return "";
  std::erase_if(auxetic, [](const auto& entry) { return entry.first >= 0; });
  if (auxetic.empty()) return "";
  return fmt::format("; {}: {} %", range_text(auxetic), percent(largest(auxetic).second.error));
}

struct Candidate {
  std::string name;
  bool large_deformation;
  const ModelErrors* errors;
  ByNu rank;  ///< where the model is valid
  double error() const { return largest(rank).second.error; }
  double uncertainty() const { return largest(rank).second.uncertainty; }
  auto breadth() const { return std::tuple(errors->cases.size(), rank.size()); }
};

/// Whether the models are judged by cases of large deformation: where there are no linear ones.
bool judged_by_large(const std::map<ModelKey, ModelErrors>& models) {
  return std::all_of(models.begin(), models.end(),
                     [](const auto& m) { return m.first.large_deformation || m.first.beside; });
}

/// The spring models that were compared most widely, the closest first.
std::vector<Candidate> candidates(const std::map<ModelKey, ModelErrors>& models) {
  std::vector<Candidate> all;
  const bool large = judged_by_large(models);
  for (const auto& [key, errors] : models)
    if (Candidate c{key.name, large, &errors, ranked(errors, errors.rank)};
        key.large_deformation == large && !key.beside && !c.rank.empty())
      all.push_back(c);
  if (all.empty()) return all;
  const auto widest = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
                        return a.breadth() < b.breadth();
                      })->breadth();
  std::erase_if(all, [&](const Candidate& c) { return c.breadth() < widest; });
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.error() < b.error(); });
  return all;
}

std::string where_text(const Candidate& c) {
  const auto cases = c.errors->cases.size();
  return fmt::format("{}, in {} {}case{}{}", range_text(c.rank), cases, c.large_deformation ? "" : "linear ",
                     cases == 1 ? "" : "s", c.large_deformation ? " of large deformation" : "");
}

/// Of displacements, or where none was compared of reactions, coarse cells included, in per cent.
std::string whole_error(const ModelErrors& e) {
  return percent(largest(ranked(e, e.displacement.empty() ? e.reaction : e.displacement)).second.error);
}

constexpr const char* reactions = "reactions of moved supports";

/// The one error that ranks the best model, in words; of its springs alone never without the whole.
std::string closest_text(const Candidate& best) {
  const ModelErrors& e = *best.errors;
  const bool doubtful = best.uncertainty() > 0.5 * best.error();  // not of the springs' own part on the same cubes
  const std::string within = percent(best.error()),
                    where =
                        where_text(best) + auxetic_clause(e) +
                        (doubtful && !(e.parts && !e.wholes)
                             ? fmt::format("; the reference itself is uncertain by {} %.", percent(best.uncertainty()))
                             : "."),
                    whole = e.parts ? whole_error(e) : "";
  if (e.parts && !e.wholes)
    return fmt::format(
        "Of the spring models {} comes closest: its springs stay within {} % of finite elements on the same cubes, its "
        "{}, coarse cells included, within {} % of the reference, {}",
        best.name, within, e.displacement.empty() ? reactions : "displacements", whole, where);
  return fmt::format("Of the spring models {} comes closest: its {} stay within {} % of finite elements{} {}",
                     best.name,
                     e.displacement.empty() ? reactions
                     : e.reaction.empty()   ? "displacements"
                                            : "displacements and the reactions of moved supports",
                     within,
                     e.parts ? fmt::format(", counting on bodies that are no blocks its springs alone ({} % with the "
                                           "coarse cells),",
                                           whole)
                             : "",
                     where);
}

std::string tied_text(const std::vector<Candidate>& tied, double uncertainty) {
  std::vector<std::string> names;
  for (const Candidate& c : tied)
    names.push_back(
        fmt::format("{} ({} %{})", c.name, percent(c.error()),
                    !c.errors->parts ? "" : fmt::format(", {} % with coarse cells", whole_error(*c.errors))));
  const ModelErrors& e = *tied.front().errors;
  return fmt::format(
      "Of the spring models {} come closest and cannot be told apart: their largest errors{}{} differ by no more than "
      "the {} % that the reference is uncertain by, {}.",
      listed(names),
      e.reaction.empty()       ? ""
      : e.displacement.empty() ? " of reactions of moved supports"
                               : " of displacement and reactions",
      e.parts ? ", on bodies that are no blocks those of their springs alone," : "", percent(uncertainty),
      where_text(tied.front()));
}

// A reference with a larger uncertainty ranks no model.
constexpr double telling_uncertainty = 0.2;

/// Of one model alone: how close it comes.
std::string untold_text(const Candidate& best, bool alone, double uncertainty) {
  const auto& [nu, worst] = largest(best.rank);
  const std::string what =
      alone
          ? fmt::format("How close {} comes the reference does not tell, {}: its largest error, {} % of the {} in {},",
                        best.name, where_text(best), percent(worst.error), worst.of, at_nu(worst.case_name, nu))
          : fmt::format("Which spring model comes closest the reference does not tell, {}: it", where_text(best));
  return fmt::format("{} is uncertain by {} %. Refine it: in [reference] {}.", what, percent(uncertainty),
                     !best.errors->voxels   ? "more cells"
                     : !best.errors->blocks ? "a smaller edge_m"
                                            : "a smaller edge_m (bodies of voxels), more cells (blocks)");
}

/// States that every model was run only at Poisson's ratios other than the one it is valid for; or nothing.
std::string no_claim_text(const std::map<ModelKey, ModelErrors>& models) {
  std::vector<std::string> names;
  for (const auto& [key, errors] : models)
    if (!key.large_deformation && !key.beside && errors.own_nu && !errors.rank.empty())
      names.push_back(fmt::format("{} (a solid of ν = {} alone)", key.name, nu_text(errors.own_nu)));
  if (names.empty()) return "";
  return fmt::format("No spring model was compared at a Poisson's ratio that it claims: {}.", listed(names));
}

/// "emsm" of "emsm in motion".
std::string without_motion(const std::string& label) {
  constexpr std::string_view ending = " in motion";
  return label.ends_with(ending) ? label.substr(0, label.size() - ending.size()) : label;
}

}  // namespace

std::string closest_at_rest(const std::map<ModelKey, ModelErrors>& models, std::vector<std::string>& closest) {
  std::vector<Candidate> all = candidates(models);
  if (all.empty()) return no_claim_text(models);
  const Candidate& best = all.front();
  double uncertainty = 0;
  std::vector<Candidate> tied;
  for (const Candidate& c : all) {
    const double doubt = std::max(best.uncertainty(), c.uncertainty());
    if (&c != &best && c.error() - best.error() > doubt) continue;
    tied.push_back(c);
    closest.push_back(c.name);
    uncertainty = std::max(uncertainty, doubt);
  }
  const bool on_same_cubes = best.errors->parts && !best.errors->wholes;
  if (uncertainty > telling_uncertainty && !(tied.size() == 1 && on_same_cubes)) {
    closest.clear();
    return untold_text(best, all.size() == 1, uncertainty);
  }
  return tied.size() == 1 ? closest_text(best) : tied_text(tied, uncertainty);
}

std::string closest_in_time(const std::map<std::string, ByNu>& models, std::vector<std::string>& closest) {
  std::size_t widest = 0;
  for (const auto& [model, errors] : models) widest = std::max(widest, errors.size());
  std::vector<std::pair<std::string, Worst>> all;
  for (const auto& [model, errors] : models)
    if (errors.size() == widest) all.emplace_back(model, largest(errors).second);
  if (all.empty()) return "";
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.second.error < b.second.error; });
  const Worst& least = all.front().second;
  std::vector<std::string> names;
  const bool alone = closest.empty();
  double uncertainty = least.uncertainty;
  for (const auto& [model, worst] : all) {
    const double doubt = std::max(worst.uncertainty, least.uncertainty);
    if (worst.error - least.error > doubt) continue;
    names.push_back(fmt::format("{} ({} %)", without_motion(model), percent(worst.error)));
    if (alone) closest.push_back(model);
    uncertainty = std::max(uncertainty, doubt);
  }
  return fmt::format("In time {}{}, by the probes' difference over the whole motion {}; these are uncertain by {} %.",
                     listed(names),
                     names.size() == 1 ? " comes closest to finite elements"
                                       : " come closest to finite elements and cannot be told apart",
                     range_text(models.at(all.front().first)), percent(uncertainty));
}

}  // namespace springproof
