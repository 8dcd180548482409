#include "comparisons/report/headline.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "comparisons/report/headline_cases.h"
#include "comparisons/report/headline_words.h"
#include "comparisons/report/model_errors.h"
#include "comparisons/report/results.h"
#include "comparisons/report/stability_words.h"

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
  return fmt::format("; a solid of ν = {} alone, {}", nu_text(errors.own_nu), there);
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
  if (!errors.springs.empty())
    out += fmt::format("; its springs within {} % of FEM on the same cubes",
                       percent(largest(errors.springs).second.error));
  if (!errors.promised.empty())
    out += fmt::format("; its cells promise {} %", percent(largest(errors.promised).second.error));
  if (!errors.reaction.empty())
    out += fmt::format("; reactions of moved supports within {} %", percent(largest(errors.reaction).second.error));
  if (!errors.volume.empty())
    out += fmt::format("; volume change within {} percentage points", percent(largest(errors.volume).second.error));
  return out + own_ratio_clause(errors) + ".";
}

/// "force on z_max": which reaction a reaction error is of, where they were measured.
std::string largest_reaction(const Json& rows, const Json& error_row) {
  struct Difference {
    double squared = 0, size = 0;
  };
  std::map<std::string, Difference> all;  // by "force.z_max"
  for (const Json& row : rows) {
    const std::string measure = string_of(row, "measure");
    const auto dot = measure.rfind('.');
    if (dot == std::string::npos || !(measure.starts_with("force.") || measure.starts_with("torque."))) continue;
    if (row.at("model") != error_row.at("model") || row.at("cells") != error_row.at("cells") ||
        row.at("poisson_ratio") != error_row.at("poisson_ratio"))
      continue;
    Difference& d = all[measure.substr(0, dot)];
    if (measure.ends_with(".magnitude"))
      d.size = number_of(row, "reference").value_or(0);
    else
      d.squared += std::pow(number_of(row, "error").value_or(0), 2);
  }
  const double error = number_of(error_row, "error").value_or(0);
  for (const auto& [name, d] : all)
    if (d.size > 0 && std::abs(std::sqrt(d.squared) / d.size - error) < 1e-2 * error) {
      const auto dot = name.find('.');
      return name.substr(0, dot) + " on " + name.substr(dot + 1);
    }
  return "reactions of moved supports";
}

std::string expected_text(const Json& check) {
  const std::string expected = number_text(number_of(check, "expected"));
  if (check.value("at_least", false)) return "at least " + expected;
  return fmt::format("{} ± {}", expected, number_text(number_of(check, "within")));
}

std::string check_line(const std::string& case_name, const Json& check) {
  const std::string where = string_of(check, "where");
  return fmt::format("{}: {}, {} at ν = {}, {}: computed {}, expected {} ({}{}{})", case_name,
                     string_of(check, "model"), string_of(check, "measure"), nu_text(number_of(check, "poisson_ratio")),
                     cells_words(check), number_text(number_of(check, "computed")), expected_text(check),
                     string_of(check, "source"), where.empty() ? "" : ", ", where);
}

std::string run_line(const std::string& case_name, const Json& run) {
  const std::string message = string_of(run, "message");
  return fmt::format("{}: {} at ν = {}, {}: {}", case_name, string_of(run, "model"),
                     nu_text(number_of(run, "poisson_ratio")), cells_words(run),
                     message.empty() ? "no reason given" : message);
}

// ---- collecting

class Collector {
 public:
  void add_case(const Json& result, std::size_t case_number) {
    const Json& experiment = object_of(result, "experiment");
    case_name_ = string_of(experiment, "name");
    large_ = string_of(experiment, "kinematics") != "linear";
    const Json& measures = list_of(experiment, "measures");
    voxels_ = object_of(experiment, "body").value("voxels", false);
    compares_displacement_ = std::find(measures.begin(), measures.end(), "displacement_error") != measures.end();
    motions_.clear();
    for (const Json& model : list_of(experiment, "models"))
      if (model.value("in_motion", false)) motions_.insert(string_of(model, "label"));
    for (const Json& check : list_of(result, "checks")) add_check(check);
    for (const Json& run : list_of(result, "runs")) add_run(run);
    append(headline_.failures, failures_of(result));
    append(headline_.verification, verification_lines(result));
    append(headline_.deformations, {deformation_line(result)});
    append(headline_.motions, motion_lines(result));
    if (const auto warning = deformation_warning(result, case_number)) headline_.warnings.push_back(*warning);
    for (Warning& warning : stability_warnings(result, case_number)) headline_.warnings.push_back(std::move(warning));
    for (const Json& caution : list_of(result, "cautions"))
      headline_.notes.push_back({case_number, case_name_ + ": " + caution.get<std::string>(), ""});
    if (!list_of(experiment, "models").empty()) add_rows(result);  // else the reference alone: no model to be judged
    for (const Json& model : list_of(experiment, "models"))
      models_for(string_of(model, "label"), number_of(model, "own_poisson_ratio"));
    if (compares_displacement_)
      for (const Json& run : list_of(result, "runs"))
        if (const auto found = models_.find({large_, string_of(run, "model")}); found != models_.end())
          found->second.asked = true;
  }

  Headline take() {
    std::map<ModelKey, ModelErrors> sorted;
    for (auto& [key, errors] : models_) {
      const bool springs = !fem_.contains(key.second) && !external_.contains(key.second);
      sorted[{key.first, !springs, order_of(key.second), key.second}] = errors;
    }
    for (const auto& [key, errors] : sorted)
      headline_.models.push_back({key.name, fem_.contains(key.name), key.large_deformation, sentence(errors)});
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

  /// Stores the only Poisson's ratio that a model is valid for, if it was compared.
  void models_for(const std::string& label, std::optional<double> own_nu) {
    if (const auto found = models_.find({large_, label}); found != models_.end()) found->second.own_nu = own_nu;
  }

  std::size_t order_of(const std::string& model) {
    const auto found = std::find(order_.begin(), order_.end(), model);
    if (found != order_.end()) return found - order_.begin();
    order_.push_back(model);
    return order_.size() - 1;
  }

  void add_run(const Json& run) {
    const std::string model = string_of(run, "model");
    if (string_of(run, "kind") == "fem") fem_.insert(model);
    if (string_of(run, "kind") == "external") external_.insert(model);
    if (compares_displacement_ && string_of(run, "kind") == "msm" && !motions_.contains(model))
      models_[{large_, model}];
    order_of(model);
    if (!run.value("ok", false)) headline_.failed_runs.push_back(run_line(case_name_, run));
  }

  void add_rows(const Json& result) {
    std::map<std::string, double> finest;
    for (const Json& row : list_of(result, "rows")) {
      double& cells = finest[string_of(row, "model")];
      cells = std::max(cells, cell_count(cells_of(row)));
    }
    const auto is_finest = [&](const Json& item) {
      return cell_count(cells_of(item)) == finest[string_of(item, "model")];
    };
    std::map<std::tuple<std::string, double, std::string>, double> own_parts;  // by model, nu and measure
    for (const Json& split : list_of(result, "splits"))
      if (const auto part = number_of(split, "model_error"), nu = number_of(split, "poisson_ratio");
          part && nu && is_finest(split))
        own_parts[{string_of(split, "model"), *nu, string_of(split, "measure")}] = *part;
    // Where a model has no part, all are ranked by their whole errors.
    std::set<std::pair<double, std::string>> ranked_by_parts;
    for (const auto& [key, part] : own_parts) ranked_by_parts.insert({std::get<1>(key), std::get<2>(key)});
    for (const Json& row : list_of(result, "rows"))
      if (const auto nu = number_of(row, "poisson_ratio");
          nu && is_finest(row) && is_ranked(string_of(row, "model")) &&
          !own_parts.contains({string_of(row, "model"), *nu, string_of(row, "measure")}))
        ranked_by_parts.erase({*nu, string_of(row, "measure")});
    for (const Json& row : list_of(result, "rows"))
      if (is_finest(row))
        add_row(row, own_parts, ranked_by_parts,
                string_of(row, "measure") == "reaction_error" ? largest_reaction(list_of(result, "rows"), row)
                                                              : "displacement");
  }

  /// Whether a model has springs of its own, at rest: what is extrapolated has none.
  bool is_ranked(const std::string& model) const {
    return !fem_.contains(model) && !external_.contains(model) && !motions_.contains(model) &&
           !model.ends_with("extrapolated");
  }

  /// `of`: what the error is of.
  void add_row(const Json& row, const std::map<std::tuple<std::string, double, std::string>, double>& own_parts,
               const std::set<std::pair<double, std::string>>& ranked_by_parts, const std::string& of) {
    const std::string measure = string_of(row, "measure"), model = string_of(row, "model");
    const auto nu = number_of(row, "poisson_ratio"), error = number_of(row, "error");
    if (nu && error && measure == "motion_error")
      in_time_[model][*nu].take(*error, number_of(row, "reference_uncertainty").value_or(0), case_name_);
    const bool displacement = measure == "displacement_error", reaction = measure == "reaction_error";
    if (const auto value = number_of(row, "value"); nu && value && measure == "promised_error")
      models_[{large_, model}].promised[*nu].take(*value, 0, case_name_);
    if (!nu || !error || !(displacement || reaction || measure == "volume_change")) return;
    if (motions_.contains(model)) return;
    const double uncertainty = number_of(row, "reference_uncertainty").value_or(0);
    ModelErrors& errors = models_[{large_, model}];
    ByNu& kind = displacement ? errors.displacement : reaction ? errors.reaction : errors.volume;
    kind[*nu].take(std::abs(*error), uncertainty, case_name_);
    if (!displacement && !reaction) return;
    errors.cases.insert(case_name_);
    (voxels_ ? errors.voxels : errors.blocks) = true;
    const auto part = own_parts.find({model, *nu, measure});
    const bool has_part = part != own_parts.end();
    if (has_part && displacement) errors.springs[*nu].take(part->second, uncertainty, case_name_);
    const bool by_part = ranked_by_parts.contains({*nu, measure});
    const bool others_have_parts = std::any_of(own_parts.begin(), own_parts.end(), [&](const auto& other) {
      return std::get<1>(other.first) == *nu && std::get<2>(other.first) == measure;
    });
    if (others_have_parts && !is_ranked(model)) return;
    (by_part ? errors.parts : errors.wholes) = true;
    errors.rank[*nu].take(by_part ? part->second : *error, uncertainty, case_name_, of);
  }

  void add_check(const Json& check) {
    const std::string verdict = string_of(check, "verdict");
    if (verdict == "pass") ++headline_.held;
    if (verdict == "reference too coarse") ++headline_.reference_too_coarse;
    if (verdict == "no reference") ++headline_.no_reference;
    if (verdict == "no result") ++headline_.no_result;
    if (verdict == "fail") {
      ++headline_.failed;
      headline_.failed_checks.push_back(check_line(case_name_, check));
    }
  }

  Headline headline_;
  std::string case_name_;
  bool large_ = false, voxels_ = false, compares_displacement_ = false;
  std::map<std::pair<bool, std::string>, ModelErrors> models_;
  std::set<std::string> fem_, external_;  ///< elements; displacements of other programs
  std::set<std::string> motions_;         ///< models of the case that are in motion: shown, not judged
  std::map<std::string, ByNu> in_time_;   ///< differences of models from finite elements in time
  std::vector<std::string> order_;
};

}  // namespace

Headline headline(const Json& results) {
  Collector collector;
  const Json& cases = list_of(results, "cases");
  for (std::size_t i = 0; i < cases.size(); ++i) collector.add_case(cases[i], i);
  Headline h = collector.take();
  if (h.answer.empty()) h.answer = stability_answer(cases);
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
