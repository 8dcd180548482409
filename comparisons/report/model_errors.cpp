#include "comparisons/report/model_errors.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "comparisons/report/words.h"
#include "problem/material.h"

namespace springproof {
namespace {

using namespace words;

// A reference with a larger uncertainty ranks no model.
constexpr double telling_uncertainty = 0.2;

/// How widely a model was compared where it is ranked.
std::pair<std::size_t, std::size_t> breadth(const ModelErrors& errors) {
  const ByNu rank = ranked(errors, errors.rank);
  return {rank.empty() ? 0 : errors.cases.size(), rank.size()};
}

struct Candidate {
  std::string name;
  bool large_deformation;
  const ModelErrors* errors;
  ByNu rank;  ///< where the model is valid
  const Worst& worst() const { return largest(rank).second; }
  double error() const { return worst().error; }
  double uncertainty() const { return worst().uncertainty; }
};

/// Whether the models are judged by cases of large deformation: where there are no linear ones.
bool judged_by_large(const std::map<ModelKey, ModelErrors>& models) {
  return std::ranges::all_of(models, [](const auto& m) { return m.first.large_deformation || m.first.beside; });
}

/// The spring models that were compared most widely, the closest first.
std::vector<Candidate> candidates(const std::map<ModelKey, ModelErrors>& models) {
  std::vector<Candidate> all;
  const bool large = judged_by_large(models);
  for (const auto& [key, errors] : models)
    if (Candidate c{key.name, large, &errors, ranked(errors, errors.rank)};
        key.large_deformation == large && !key.beside && !c.rank.empty())
      all.push_back(c);
  std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return ranks_before(*a.errors, *b.errors); });
  if (!all.empty())
    std::erase_if(all,
                  [widest = breadth(*all.front().errors)](const Candidate& c) { return breadth(*c.errors) < widest; });
  return all;
}

/// "for ν from 0 to 0.4, in 2 linear cases of 800 to 1000 cells; ν = −0.5, left out here: 30 %".
std::string where_text(const Candidate& c) {
  const auto cases = c.errors->cases.size();
  const std::string cells = cells_range(*c.errors);
  ByNu auxetic = claimed(*c.errors, c.errors->rank);
  std::erase_if(auxetic, [&](const auto& entry) { return c.rank.contains(entry.first); });
  std::string out = fmt::format(
      "{}, in {} {}case{}{}{}", range_text(c.rank), cases, c.large_deformation ? "" : "linear ", cases == 1 ? "" : "s",
      c.large_deformation ? " of large deformation" : "", cells.empty() ? "" : fmt::format(" of {} cells", cells));
  if (!auxetic.empty())
    out += fmt::format("; left out here: {} % {}", percent(largest(auxetic).second.error), range_text(auxetic));
  return out;
}

const char* compared_words(const ModelErrors& e) {
  return e.displacement.empty() ? "reactions of moved supports"
         : e.reaction.empty()   ? "displacements"
                                : "displacements and the reactions of moved supports";
}

/// "within 6.5 % of finite elements (uncertain by 0.2 %)": never an error without the uncertainty of its reference.
std::string within_text(const Candidate& c) {
  const bool doubtful = c.uncertainty() > 0.5 * c.error();
  return fmt::format(
      "within {} % of finite elements{}", percent(c.error()),
      doubtful ? fmt::format(", as far as these can tell: they are uncertain by {} %,", percent(c.uncertainty()))
               : fmt::format(" (uncertain by {} %)", percent(c.uncertainty())));
}

std::string closest_text(const Candidate& best, bool alone) {
  return fmt::format("{}: its {} are {} {}.",
                     alone ? best.name : fmt::format("Of the spring models {} comes closest", best.name),
                     compared_words(*best.errors), within_text(best), where_text(best));
}

std::string tied_text(const std::vector<Candidate>& tied, double uncertainty) {
  const double place = tied.front().worst().place;
  std::vector<std::string> names;
  for (const Candidate& c : tied) names.push_back(fmt::format("{} ({} %)", c.name, percent(c.error())));
  const ModelErrors& e = *tied.front().errors;
  return fmt::format(
      "Of the spring models {} come closest and cannot be told apart: their largest errors{} differ by no more than "
      "the {} % that the reference {} uncertain by, {}.",
      listed(names),
      e.reaction.empty()       ? ""
      : e.displacement.empty() ? " of reactions of moved supports"
                               : " of displacement and reactions",
      percent(uncertainty + place), place > 0 ? "and the place of whole cubes are" : "is", where_text(tied.front()));
}

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
      names.push_back(fmt::format("{} (a solid of ν = {} alone)", key.name, nu_text(*errors.own_nu)));
  if (names.empty()) return "";
  return fmt::format("No spring model was compared at a Poisson's ratio that it claims: {}.", listed(names));
}

/// "emsm" of "emsm in motion".
std::string without_motion(const std::string& label) {
  constexpr std::string_view ending = " in motion";
  return label.ends_with(ending) ? label.substr(0, label.size() - ending.size()) : label;
}

}  // namespace

std::string range_text(double from, double to) {
  return from == to ? fmt::format("at ν = {}", nu_text(from))
                    : fmt::format("for ν from {} to {}", nu_text(from), nu_text(to));
}

std::string range_text(const ByNu& errors) { return range_text(errors.begin()->first, errors.rbegin()->first); }

const std::pair<const double, Worst>& largest(const ByNu& errors) {
  return *std::ranges::max_element(errors,
                                   [](const auto& a, const auto& b) { return a.second.error < b.second.error; });
}

ByNu claimed(const ModelErrors& errors, const ByNu& by_nu) {
  ByNu out = by_nu;
  if (errors.own_nu)
    std::erase_if(out, [&](const auto& entry) { return !same_poisson_ratio(entry.first, *errors.own_nu); });
  return out;
}

ByNu ranked(const ModelErrors& errors, const ByNu& by_nu) {
  ByNu all = claimed(errors, by_nu), ordinary = all;
  std::erase_if(ordinary, [](const auto& entry) { return entry.first < 0; });
  return ordinary.empty() ? all : ordinary;
}

std::string cells_range(const ModelErrors& errors) {
  if (errors.cells.empty()) return "";
  const auto text = [](std::size_t n) {
    return n < 10000 ? fmt::format("{}", n) : fmt::format("{},{:03}", n / 1000, n % 1000);
  };
  const std::size_t few = *errors.cells.begin(), many = *errors.cells.rbegin();
  return few == many ? text(few) : fmt::format("{} to {}", text(few), text(many));
}

bool ranks_before(const ModelErrors& a, const ModelErrors& b) {
  if (breadth(a) != breadth(b)) return breadth(a) > breadth(b);
  const ByNu of_a = ranked(a, a.rank), of_b = ranked(b, b.rank);
  return !of_a.empty() && largest(of_a).second.error < largest(of_b).second.error;
}

std::string closest_at_rest(const std::map<ModelKey, ModelErrors>& models, std::vector<std::string>& closest) {
  std::vector<Candidate> all = candidates(models);
  if (all.empty()) return no_claim_text(models);
  const Candidate& best = all.front();
  double uncertainty = 0;
  std::vector<Candidate> tied;
  for (const Candidate& c : all) {
    const double doubt = std::max(best.uncertainty(), c.uncertainty());
    if (&c != &best && c.error() - best.error() > doubt + best.worst().place) continue;  // no more than luck
    tied.push_back(c);
    closest.push_back(c.name);
    uncertainty = std::max(uncertainty, doubt);
  }
  const auto spring_models = std::ranges::count_if(models, [&](const auto& m) {
    return !m.first.beside && m.first.large_deformation == best.large_deformation &&
           !ranked(m.second, m.second.rank).empty();
  });
  if (uncertainty > telling_uncertainty) {
    closest.clear();
    return untold_text(best, all.size() == 1, uncertainty);
  }
  return tied.size() == 1 ? closest_text(best, spring_models == 1) : tied_text(tied, uncertainty);
}

std::string closest_in_time(const std::map<std::string, ByNu>& models, std::vector<std::string>& closest) {
  std::size_t widest = 0;
  for (const auto& [model, errors] : models) widest = std::max(widest, errors.size());
  std::vector<std::pair<std::string, Worst>> all;
  for (const auto& [model, errors] : models)
    if (errors.size() == widest) all.emplace_back(model, largest(errors).second);
  if (all.empty()) return "";
  std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return a.second.error < b.second.error; });
  const Worst& least = all.front().second;
  std::vector<std::string> names;
  const bool unnamed = closest.empty();
  double uncertainty = least.uncertainty;
  for (const auto& [model, worst] : all) {
    const double doubt = std::max(worst.uncertainty, least.uncertainty);
    if (worst.error - least.error > doubt) continue;
    names.push_back(fmt::format("{} ({} %)", without_motion(model), percent(worst.error)));
    if (unnamed) closest.push_back(model);
    uncertainty = std::max(uncertainty, doubt);
  }
  const std::string where = range_text(models.at(all.front().first));
  if (all.size() == 1)
    return fmt::format(
        "In time {} is within {} % of finite elements {}, by the probes' difference over the whole motion; these are "
        "uncertain by {} %.",
        without_motion(all.front().first), percent(least.error), where, percent(uncertainty));
  return fmt::format("In time {}{}, by the probes' difference over the whole motion {}; these are uncertain by {} %.",
                     listed(names),
                     names.size() == 1 ? " comes closest to finite elements"
                                       : " come closest to finite elements and cannot be told apart",
                     where, percent(uncertainty));
}

}  // namespace springproof
