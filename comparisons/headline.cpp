#include "comparisons/headline.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "comparisons/results.h"

namespace springproof {
namespace {

using Json = nlohmann::json;

/// The largest error at one Poisson's ratio, over the cases.
struct Worst {
  double error = -1;
  double uncertainty = 0;
  std::string case_name;
};

struct ModelErrors {
  std::map<double, Worst> displacement, volume;  // by Poisson's ratio
  std::set<std::string> cases;                   // in which a displacement was compared
};

struct ModelKey {
  bool large_deformation, fem;
  std::size_t order;  // of first appearance
  std::string name;
  auto operator<=>(const ModelKey&) const = default;
};

std::string string_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

std::optional<double> number_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

const Json& list_of(const Json& object, const char* key) {
  static const Json none = Json::array();
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : none;
}

Cells cells_of(const Json& item) {
  const Json& list = list_of(item, "cells");
  Cells cells = {0, 0, 0};
  for (std::size_t d = 0; d < 3 && d < list.size(); ++d)
    if (list[d].is_number()) cells[d] = list[d].get<int>();
  return cells;
}

// ---- words

std::string minus(std::string number) {
  for (std::size_t i = 0; (i = number.find('-', i)) != std::string::npos; ++i) number.replace(i, 1, "−");
  return number;
}

std::string number_text(std::optional<double> x) {
  return x ? minus(fmt::format("{}", *x)) : "nothing";
}

/// Two significant digits, a fraction as percent: 0.0191 -> "1.9".
std::string percent(double fraction) {
  const double x = 100 * fraction;
  if (x < 1e-3) return "0.001";
  return x >= 99.5 ? fmt::format("{:.0f}", x) : fmt::format("{:.2g}", x);
}

/// At most six significant digits: 0.499975.
std::string nu_text(std::optional<double> nu) {
  return nu ? minus(fmt::format("{:.6g}", *nu)) : "nothing";
}

/// "10×10×10 cells" or "812 tets".
std::string cells_words(const Json& item) {
  const Cells cells = cells_of(item);
  return cells_text(cells, "×") + (is_tetrahedra(cells) ? "" : " cells");
}

std::string range_text(double from, double to) {
  return from == to ? fmt::format("at ν = {}", nu_text(from))
                    : fmt::format("for ν from {} to {}", nu_text(from), nu_text(to));
}

/// The listed Poisson's ratios at which the error stays within `limit`: "for ν from 0 to 0.4 and at ν =
/// 0.49".
std::string where_within(const std::map<double, Worst>& errors, double limit) {
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

/// The first of 1 % and 5 % that is held somewhere but not everywhere.
std::string tighter_clause(const std::map<double, Worst>& errors, double worst) {
  for (double limit : {0.01, 0.05}) {
    const std::string where = where_within(errors, limit);
    if (worst > limit && !where.empty()) return fmt::format("; within {} % {}", percent(limit), where);
  }
  return "";
}

const std::pair<const double, Worst>& largest(const std::map<double, Worst>& errors) {
  return *std::max_element(errors.begin(), errors.end(),
                           [](const auto& a, const auto& b) { return a.second.error < b.second.error; });
}

std::string sentence(const ModelErrors& errors) {
  if (errors.displacement.empty()) return "no displacement could be compared.";
  const auto& [nu, worst] = largest(errors.displacement);
  std::string out =
      fmt::format("displacement within {} % of FEM {} (worst: {} at ν = {}", percent(worst.error),
                  range_text(errors.displacement.begin()->first, errors.displacement.rbegin()->first),
                  worst.case_name, nu_text(nu));
  if (worst.error <= worst.uncertainty)
    out += fmt::format(", below the {} % uncertainty of the reference", percent(worst.uncertainty));
  out += ")";
  out += tighter_clause(errors.displacement, worst.error);
  if (!errors.volume.empty())
    out += fmt::format("; volume change within {} percentage points",
                       percent(largest(errors.volume).second.error));
  return out + ".";
}

std::string expected_text(const Json& check) {
  const std::string expected = number_text(number_of(check, "expected"));
  if (check.value("at_least", false)) return "at least " + expected;
  return fmt::format("{} ± {}", expected, number_text(number_of(check, "within")));
}

std::string check_line(const std::string& case_name, const Json& check) {
  const std::string where = string_of(check, "where");
  return fmt::format(
      "{}: {}, {} at ν = {}, {}: computed {}, expected {} ({}{}{})", case_name,
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

/// The spring model that was compared most widely and, among those, has the smallest largest error.
std::string answer(const std::map<ModelKey, ModelErrors>& models) {
  const std::pair<const ModelKey, ModelErrors>* best = nullptr;
  const auto rank = [](const ModelErrors& e) {
    return std::tuple(-static_cast<int>(e.cases.size()), -static_cast<int>(e.displacement.size()),
                      largest(e.displacement).second.error);
  };
  for (const auto& entry : models) {
    if (entry.first.large_deformation || entry.first.fem || entry.second.displacement.empty()) continue;
    if (!best || rank(entry.second) < rank(best->second)) best = &entry;
  }
  if (!best) return "";
  const auto& [key, errors] = *best;
  const auto cases = errors.cases.size();
  return fmt::format(
      "Of the spring models {} comes closest: its displacements stay within {} % of finite elements {}, in "
      "{} linear "
      "case{}.",
      key.name, percent(largest(errors.displacement).second.error),
      range_text(errors.displacement.begin()->first, errors.displacement.rbegin()->first), cases,
      cases == 1 ? "" : "s");
}

// ---- collecting

class Collector {
 public:
  void add_case(const Json& result) {
    const Json experiment = result.value("experiment", Json::object());
    case_name_ = string_of(experiment, "name");
    large_ = string_of(experiment, "kinematics") != "linear";
    const Json& measures = list_of(experiment, "measures");
    compares_displacement_ =
        std::find(measures.begin(), measures.end(), "displacement_error") != measures.end();
    for (const Json& check : list_of(result, "checks")) add_check(check);
    const bool verifies = list_of(experiment, "models").empty();  // the reference alone: no model to be judged
    for (const Json& run : list_of(result, "runs")) add_run(run);
    if (verifies) return;
    std::map<std::string, double> finest;
    for (const Json& row : list_of(result, "rows")) {
      double& cells = finest[string_of(row, "model")];
      cells = std::max(cells, cell_count(cells_of(row)));
    }
    for (const Json& row : list_of(result, "rows"))
      if (cell_count(cells_of(row)) == finest[string_of(row, "model")]) add_row(row);
  }

  Headline take() {
    std::map<ModelKey, ModelErrors> sorted;
    for (auto& [key, errors] : models_) {
      const bool fem = fem_.contains(key.second);
      sorted[{key.first, fem, order_of(key.second), key.second}] = errors;
    }
    for (const auto& [key, errors] : sorted)
      headline_.models.push_back({key.name, key.fem, key.large_deformation, sentence(errors)});
    headline_.answer = answer(sorted);
    return headline_;
  }

 private:
  std::size_t order_of(const std::string& model) {
    const auto found = std::find(order_.begin(), order_.end(), model);
    if (found != order_.end()) return found - order_.begin();
    order_.push_back(model);
    return order_.size() - 1;
  }

  void add_run(const Json& run) {
    const std::string model = string_of(run, "model");
    if (string_of(run, "kind") == "fem") fem_.insert(model);
    if (compares_displacement_ && string_of(run, "kind") == "msm") models_[{large_, model}];
    order_of(model);
    if (!run.value("ok", false)) headline_.failed_runs.push_back(run_line(case_name_, run));
  }

  void add_row(const Json& row) {
    const std::string measure = string_of(row, "measure");
    const auto nu = number_of(row, "poisson_ratio"), error = number_of(row, "error");
    if (!nu || !error || (measure != "displacement_error" && measure != "volume_change")) return;
    ModelErrors& errors = models_[{large_, string_of(row, "model")}];
    if (measure == "displacement_error") errors.cases.insert(case_name_);
    Worst& worst = (measure == "volume_change" ? errors.volume : errors.displacement)[*nu];
    if (std::abs(*error) > worst.error)
      worst = {std::abs(*error), number_of(row, "reference_uncertainty").value_or(0), case_name_};
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
  bool large_ = false, compares_displacement_ = false;
  std::map<std::pair<bool, std::string>, ModelErrors> models_;
  std::set<std::string> fem_;
  std::vector<std::string> order_;
};

}  // namespace

Headline headline(const Json& results) {
  Collector collector;
  for (const Json& result : list_of(results, "cases")) collector.add_case(result);
  return collector.take();
}

std::string expectations_sentence(const Headline& h) {
  const int all = h.held + h.failed + h.reference_too_coarse + h.no_reference + h.no_result;
  if (all == 0) return "No expectations are stated.";
  std::string out = fmt::format("{} of {} expectations hold", h.held, all);
  if (h.failed) out += fmt::format(", {} fail{}", h.failed, h.failed == 1 ? "s" : "");
  if (h.reference_too_coarse)
    out += fmt::format(", for {} the reference is too coarse", h.reference_too_coarse);
  if (h.no_reference) out += fmt::format(", for {} there is no reference", h.no_reference);
  if (h.no_result) out += fmt::format(", for {} there is no result", h.no_result);
  return out + ".";
}

}  // namespace springproof
