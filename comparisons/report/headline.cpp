#include "comparisons/report/headline.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "comparisons/report/headline_cases.h"
#include "comparisons/report/words.h"

namespace springproof {
namespace {

using namespace words;

/// The listed Poisson's ratios at which the error stays within `limit`: "for ν from 0 to 0.4 and at ν =
/// 0.49".
std::string where_within(const ByNu& errors, double limit) {
  std::vector<std::string> parts;
  for (auto it = errors.begin(); it != errors.end();) {
    if (it->second.error > limit) {
      ++it;
      continue;
    }
    const double from = it->first;
    double to = from;
    for (; it != errors.end() && it->second.error <= limit; ++it) to = it->first;
    parts.push_back(range_text(from, to));
  }
  return fmt::format("{}", fmt::join(parts, " and "));
}

/// The first of the limits 1 % and 5 % that is met at some Poisson's ratios but not at every one.
std::string tighter_clause(const ByNu& errors, double worst) {
  for (double limit : {0.01, 0.05}) {
    const std::string where = where_within(errors, limit);
    if (worst > limit && !where.empty()) return fmt::format("; within {} % {}", percent(limit), where);
  }
  return "";
}

std::string own_ratio_clause(const ModelErrors& errors) {
  const ByNu own = claimed(errors, errors.displacement);
  if (!errors.own_nu || own.size() == errors.displacement.size()) return "";
  const std::string there =
      own.empty() ? "which was not run" : fmt::format("there within {} %", percent(largest(own).second.error));
  return fmt::format("; a solid of ν = {} alone, {}", nu_text(*errors.own_nu), there);
}

std::string displacement_clause(const ByNu& errors) {
  const auto& [nu, worst] = largest(errors);
  std::string out = fmt::format("displacement within {} % of FEM {} (worst: {}", percent(worst.error),
                                range_text(errors), at_nu(worst.case_name, nu));
  if (worst.error <= worst.uncertainty)
    out += fmt::format(", below the {} % uncertainty of the reference", percent(worst.uncertainty));
  return out + ")" + tighter_clause(errors, worst.error);
}

std::string sentence(const ModelErrors& errors) {
  std::string out = errors.displacement.empty()
                        ? errors.asked ? "no displacement could be compared" : "displacement was not asked for"
                        : displacement_clause(errors.displacement);
  if (!errors.promised.empty())
    out += fmt::format("; its cells estimate {} %", percent(largest(errors.promised).second.error));
  if (!errors.reaction.empty())
    out += fmt::format("; reactions of moved supports within {} %", percent(largest(errors.reaction).second.error));
  if (!errors.volume.empty())
    out += fmt::format("; volume change within {} percentage points", percent(largest(errors.volume).second.error));
  return out + own_ratio_clause(errors) + ".";
}

std::string expected_text(const Check& check) {
  if (check.at_least) return "at least " + number_text(check.expected);
  return fmt::format("{} ± {}", number_text(check.expected), number_text(check.within));
}

std::string check_line(const Experiment& e, const Check& check) {
  return fmt::format("{}: {}, {} at {}, {}: computed {}, expected {} ({}{}{})", e.name, check.model, check.measure,
                     setting_text(e, check.poisson_ratio), cells_words(check.cells), number_text(check.computed),
                     expected_text(check), check.source, check.where.empty() ? "" : ", ", check.where);
}

std::string run_line(const Experiment& e, const Run& run) {
  return fmt::format("{}: {} at {}, {}: {}", e.name, run.model, setting_text(e, run.poisson_ratio),
                     cells_words(run.cells), run.message.empty() ? "no reason given" : run.message);
}

/// "force on z_max" of "force.z_max".
std::string reaction_words(const std::string& of) {
  const auto dot = of.find('.');
  return dot == std::string::npos ? "reactions of moved supports" : of.substr(0, dot) + " on " + of.substr(dot + 1);
}

/// What 8-node elements in the same whole cubes of a body are off by, the most at a Poisson's ratio that models are
/// ranked by; in cut cells and in blocks nothing.
double error_of_cubes(const CaseResult& result, const Row& row) {
  if (!result.experiment.body.is_voxels()) return 0;
  const auto cells = [&](const RunKey& key) {
    const auto run = std::ranges::find_if(result.runs, [&](const Run& r) { return same_run(r, key); });
    return run == result.runs.end() ? 0 : run->filled;
  };
  RunKey elements = row;
  elements.model = "fem_q1";
  if (cells(row) == 0 || cells(row) != cells(elements)) return 0;
  double most = 0;
  for (const Row& r : result.rows)
    if (r.model == elements.model && r.cells == row.cells && r.measure == row.measure && r.poisson_ratio >= 0)
      most = std::max(most, std::abs(r.error.value_or(0)));
  return most;
}

// ---- collecting

class Collector {
 public:
  void add_case(const CaseResult& result, std::size_t case_number) {
    const Experiment& e = result.experiment;
    case_name_ = e.name;
    large_ = e.kinematics != "linear";
    compares_displacement_ = std::ranges::find(e.measures, "displacement_error") != e.measures.end();
    motions_.clear();
    for (const ModelChoice& model : e.models) {
      if (model.in_motion) motions_.insert(model.label);
      if (is_external(model) && !is_own_model(model)) beside_.insert(model.label);
    }
    for (const Check& check : result.checks) add_check(e, check);
    for (const Run& run : result.runs) add_run(e, run);
    append(headline_.failures, failures_of(result));
    append(headline_.verification, verification_lines(result));
    append(headline_.measured, measured_lines(result));
    append(headline_.deformations, {deformation_line(result)});
    append(headline_.motions, motion_lines(result));
    if (const auto warning = deformation_warning(result, case_number)) headline_.warnings.push_back(*warning);
    for (Warning& warning : stability_warnings(result, case_number)) headline_.warnings.push_back(std::move(warning));
    for (const std::string& caution : cautions(result))
      headline_.notes.push_back({case_number, case_name_ + ": " + caution, ""});
    if (!e.models.empty()) add_rows(result);  // else the reference alone: no model to be judged
    for (const auto& [label, own_nu] : result.own_poisson_ratios)
      if (const auto found = models_.find({large_, label}); found != models_.end()) found->second.own_nu = own_nu;
    if (compares_displacement_)
      for (const Run& run : result.runs)
        if (const auto found = models_.find({large_, run.model}); found != models_.end()) found->second.asked = true;
  }

  Headline take() {
    std::map<ModelKey, ModelErrors> sorted;
    for (auto& [key, errors] : models_)
      sorted[{key.first, is_beside(key.second), order_of(key.second), key.second}] = errors;
    for (const auto& [key, errors] : sorted)
      headline_.models.push_back({key.name, key.beside, key.large_deformation, errors, sentence(errors)});
    std::ranges::stable_sort(headline_.models, [](const auto& a, const auto& b) {
      if (a.large_deformation != b.large_deformation) return b.large_deformation;
      return a.beside != b.beside ? b.beside : ranks_before(a.errors, b.errors);
    });
    headline_.answer = closest_at_rest(sorted, headline_.closest);
    if (const std::string in_time = closest_in_time(in_time_, headline_.closest); !in_time.empty())
      headline_.answer += (headline_.answer.empty() ? "" : " ") + in_time;
    return headline_;
  }

 private:
  static void append(std::vector<std::string>& lines, const std::vector<std::string>& more) {
    std::copy_if(more.begin(), more.end(), std::back_inserter(lines),
                 [](const std::string& line) { return !line.empty(); });
  }

  /// What is no spring model: elements, limits of two lattices, what another program computed for comparison.
  bool is_beside(const std::string& model) const {
    return beside_.contains(model) || model.ends_with(extrapolated_suffix);
  }

  std::size_t order_of(const std::string& model) {
    const auto found = std::ranges::find(order_, model);
    if (found != order_.end()) return found - order_.begin();
    order_.push_back(model);
    return order_.size() - 1;
  }

  void add_run(const Experiment& e, const Run& run) {
    if (run.kind == "fem") beside_.insert(run.model);
    if (compares_displacement_ && run.kind == "msm" && !motions_.contains(run.model)) models_[{large_, run.model}];
    order_of(run.model);
    if (!run.ok) headline_.failed_runs.push_back(run_line(e, run));
  }

  void add_rows(const CaseResult& result) {
    std::map<std::string, double> finest;
    for (const Row& row : result.rows) {
      double& cells = finest[row.model];
      cells = std::max(cells, cell_count(row.cells));
    }
    for (const Row& row : result.rows)
      if (cell_count(row.cells) == finest[row.model]) add_row(result, row);
  }

  void add_row(const CaseResult& result, const Row& row) {
    const auto is = [&](const char* measure) { return row.measure == measure; };
    const Experiment& e = result.experiment;
    // A list of a region is named behind the case; what models are ranked by is what the rest of the body has.
    const bool of_region = e.listed.region > 0;
    const double nu = of_region ? e.materials.front().poisson_ratio : row.poisson_ratio;
    const std::string where =
        of_region ? fmt::format("{} ({})", case_name_, setting_text(e, row.poisson_ratio)) : case_name_;
    if (is("promised_error")) models_[{large_, row.model}].promised[nu].take({row.value, 0, 0, where});
    if (!row.error || !std::isfinite(*row.error)) return;
    const Worst error{std::abs(*row.error), row.reference_uncertainty.value_or(0), error_of_cubes(result, row), where,
                      is("reaction_error") ? reaction_words(row.of) : "displacement"};
    if (is("motion_error")) in_time_[row.model][nu].take(error);
    if (motions_.contains(row.model)) return;
    ModelErrors& errors = models_[{large_, row.model}];
    if (is("volume_change")) errors.volume[nu].take(error);
    if (!is("displacement_error") && !is("reaction_error")) return;
    (is("displacement_error") ? errors.displacement : errors.reaction)[nu].take(error);
    errors.rank[nu].take(error);
    errors.cases.insert(case_name_);
    for (const Run& run : result.runs) {
      if (!run.ok || !same_run(run, row)) continue;
      if (run.filled > 0) errors.cells.insert(run.filled);
      if (is("displacement_error") && run.seconds > 0) errors.seconds.push_back(run.seconds);
    }
    (result.experiment.body.is_voxels() ? errors.voxels : errors.blocks) = true;
  }

  void add_check(const Experiment& e, const Check& check) {
    ++(check.verdict == Verdict::pass                   ? headline_.held
       : check.verdict == Verdict::fail                 ? headline_.failed
       : check.verdict == Verdict::reference_too_coarse ? headline_.reference_too_coarse
       : check.verdict == Verdict::no_reference         ? headline_.no_reference
                                                        : headline_.no_result);
    if (check.verdict == Verdict::fail) headline_.failed_checks.push_back(check_line(e, check));
  }

  Headline headline_;
  std::string case_name_;
  bool large_ = false, compares_displacement_ = false;
  std::map<std::pair<bool, std::string>, ModelErrors> models_;
  std::set<std::string> beside_;         ///< elements; displacements of other programs that are only shown
  std::set<std::string> motions_;        ///< models of the case that are in motion: shown, not judged
  std::map<std::string, ByNu> in_time_;  ///< differences of models from finite elements in time
  std::vector<std::string> order_;
};

}  // namespace

Headline headline(const std::vector<CaseResult>& cases) {
  Collector collector;
  for (std::size_t i = 0; i < cases.size(); ++i) collector.add_case(cases[i], i);
  Headline h = collector.take();
  if (h.answer.empty()) h.answer = stability_answer(cases);
  if (const std::string motion = motion_sentence(cases, h.closest); !motion.empty())
    h.answer += (h.answer.empty() ? "" : " ") + motion;
  if (!h.answer.empty()) h.no_linear_theory = beyond_linear_theory(cases);
  h.doubt = doubt_of_reference(cases);
  return h;
}

bool success(const Headline& h) {
  return h.failed + h.no_result + h.no_reference + h.reference_too_coarse == 0 && h.failures.empty();
}

std::string expectations_sentence(const Headline& h) {
  const int all = h.held + h.failed + h.reference_too_coarse + h.no_reference + h.no_result;
  if (all == 0) return "No expectations are stated.";
  std::string out = fmt::format("{} of {} expectations hold", h.held, all);
  if (h.failed) out += fmt::format(", {} fail{}", h.failed, h.failed == 1 ? "s" : "");
  if (h.reference_too_coarse) out += fmt::format(", for {} the reference is too coarse", h.reference_too_coarse);
  if (h.no_reference) out += fmt::format(", for {} there is no reference", h.no_reference);
  if (h.no_result) out += fmt::format(", for {} there is no result", h.no_result);
  return out + ".";
}

}  // namespace springproof
