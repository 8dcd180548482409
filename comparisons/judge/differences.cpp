#include "comparisons/judge/differences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <nlohmann/json.hpp>

#include "comparisons/judge/reference_value.h"
#include "problem/files/files.h"
#include "problem/system/input_error.h"
#include "problem/system/json.h"

namespace springproof {
namespace {

using nlohmann::json;

double number_or_nan(const json& j) { return j.is_null() ? std::numeric_limits<double>::quiet_NaN() : j.get<double>(); }

Row row_of(const json& j, const std::string& case_name) {
  Row row;
  row.case_name = case_name;
  row.model = j.at("model");
  row.poisson_ratio = number_or_nan(j.at("poisson_ratio"));
  row.cells = j.at("cells").get<Cells>();
  row.kinematics = j.at("kinematics");
  row.measure = j.at("measure");
  row.value = number_or_nan(j.at("value"));
  row.unit = j.at("unit");
  j.at("reference").get_to(row.reference);
  j.at("reference_uncertainty").get_to(row.reference_uncertainty);
  if (j.contains("spread")) j.at("spread").get_to(row.spread);
  return row;
}

std::string run_of(const Row& row) {
  return fmt::format("{}|{}|{}|{:.9g}|{}", row.case_name, row.kinematics, row.model, row.poisson_ratio,
                     cells_text(row.cells));
}

std::string key_of(const Row& row) { return run_of(row) + '|' + row.measure; }

double size_of(double x) { return std::isfinite(x) ? std::abs(x) : 0; }

/// Per vector of a run the largest of its components in either folder.
std::map<std::string, double> sizes(const ResultsFolder& first, const ResultsFolder& second) {
  std::map<std::string, double> largest;
  for (const ResultsFolder* folder : {&first, &second})
    for (const Row& row : folder->rows) {
      double& size = largest[run_of(row) + '|' + without_component(row.measure)];
      size = std::max({size, size_of(row.value), size_of(row.reference.value_or(0))});
    }
  return largest;
}

double relative_difference(double a, double b, double size) {
  if (std::isnan(a) && std::isnan(b)) return 0;
  if (!std::isfinite(a) || !std::isfinite(b)) return a == b ? 0 : std::numeric_limits<double>::infinity();
  return a == b ? 0 : std::abs(b - a) / std::max({size, std::abs(a), std::abs(b)});
}

}  // namespace

void refuse_results(const std::filesystem::path& folder, const std::string& why) {
  throw InputError(
      fmt::format("{}: not the results of `springproof compare`: {}", (folder / "results.json").string(), why));
}

ResultsFolder read_results(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "results.json";
  if (std::error_code ignored; !std::filesystem::exists(file, ignored))
    throw InputError(
        fmt::format("{}: no results.json here; give a folder that `springproof compare` wrote", folder.string()));
  const std::string text = read_named_file(file, "results of `springproof compare`");
  try {
    const json document = json::parse(text);
    ResultsFolder found{document.at("program").at("version"), document.at("generated"), {}, {}, {}};
    for (const json& result : document.at("cases")) {
      const json& experiment = result.at("experiment");
      const std::string group = experiment.at("folder"), name = experiment.at("name");
      found.cases.push_back(group.empty() ? name : group + '/' + name);
      if (const auto listed = experiment.find("listed"); listed != experiment.end() && listed->at("part") != "")
        found.listed[found.cases.back()] = listed->at("words");
      for (const json& row : result.at("rows")) found.rows.push_back(row_of(row, found.cases.back()));
    }
    return found;
  } catch (const json::exception& e) {
    refuse_results(folder, e.what());
  }
}

Differences differences(const ResultsFolder& first, const ResultsFolder& second, double tolerance) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::map<std::string, double> size_of_vector = sizes(first, second);
  std::map<std::string, std::deque<const Row*>> others;  // of a number that a folder holds twice the first is the first
  for (const Row& row : second.rows) others[key_of(row)].push_back(&row);
  Differences all;
  for (const Row& a : first.rows) {
    std::deque<const Row*>& alike = others[key_of(a)];
    if (alike.empty()) {
      all.only_first.push_back(a);
      continue;
    }
    const Row& b = *alike.front();
    alike.pop_front();
    ++all.in_both;
    const double size = size_of_vector.at(run_of(a) + '|' + without_component(a.measure));
    const double uncertainty = std::max(a.reference_uncertainty.value_or(0), b.reference_uncertainty.value_or(0));
    const auto compare = [&](const char* what, double x, double y) {
      const double relative = relative_difference(x, y, size);
      all.largest = std::max(all.largest, relative);
      if (relative > tolerance)
        all.changed.push_back({a, what, x, y, relative, uncertainty > 0 ? std::abs(y - x) / uncertainty : nan});
    };
    if (a.unit != b.unit) {
      all.largest = std::numeric_limits<double>::infinity();
      all.changed.push_back({a, fmt::format("unit {} for {}", b.unit, a.unit), a.value, b.value, all.largest, nan});
      continue;
    }
    compare("value", a.value, b.value);
    compare("reference", a.reference.value_or(nan), b.reference.value_or(nan));
    compare("reference_uncertainty", a.reference_uncertainty.value_or(nan), b.reference_uncertainty.value_or(nan));
  }
  for (const Row& row : second.rows)
    if (const auto& left = others.at(key_of(row)); std::ranges::find(left, &row) != left.end())
      all.only_second.push_back(row);
  std::ranges::stable_sort(all.changed,
                           [](const Difference& a, const Difference& b) { return a.relative > b.relative; });
  return all;
}

}  // namespace springproof
