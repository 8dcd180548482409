// The numbers of charts as one wide table.
#include <algorithm>
#include <cctype>
#include <set>

#include "comparisons/reproduce/chart.h"
#include "comparisons/results/records.h"

namespace springproof {
namespace {

/// Column name of a curve: letters, digits and underscores.
std::string column_name(const Chart& chart, const Curve& curve, std::size_t charts) {
  std::string name;
  for (const char c : charts > 1 ? chart.title + ' ' + curve.label : curve.label) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.';
    if (plain || (!name.empty() && name.back() != '_')) name += plain ? c : '_';
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name;
}

bool has_spread(const Curve& curve) {
  return std::ranges::any_of(curve.points, [](const CurvePoint& p) { return p.spread.has_value(); });
}

using Column = std::pair<std::string, std::vector<std::optional<double>>>;

/// One column at least.
std::string columns_csv(const std::vector<Column>& columns) {
  std::size_t lines = 0;
  for (const auto& [name, values] : columns) lines = std::max(lines, values.size());
  std::string out;
  for (std::size_t line = 0; line <= lines; ++line) {  // the names, then the values
    for (const auto& [name, values] : columns)
      out += (line == 0 ? csv_text(name) : line <= values.size() ? csv_number(values[line - 1]) : "") + ',';
    out.back() = '\n';
  }
  return out;
}

/// One x for all curves: values of a curve that has no point there are empty.
std::vector<Column> shared_columns(const std::vector<Chart>& charts) {
  std::set<double> places;
  for (const Chart& chart : charts)
    for (const Curve& curve : chart.curves)
      for (const CurvePoint& p : curve.points) places.insert(p.x);
  std::vector<Column> columns = {{"x", {places.begin(), places.end()}}};
  for (const Chart& chart : charts)
    for (const Curve& curve : chart.curves) {
      const std::string name = column_name(chart, curve, charts.size());
      Column y = {name, {}}, spread = {name + "_spread", {}};
      for (double x : places) {
        const auto found = std::ranges::find_if(curve.points, [&](const CurvePoint& p) { return p.x == x; });
        const bool here = found != curve.points.end();
        y.second.push_back(here ? std::optional(found->y) : std::nullopt);
        spread.second.push_back(here ? found->spread : std::nullopt);
      }
      columns.push_back(std::move(y));
      if (has_spread(curve)) columns.push_back(std::move(spread));
    }
  return columns;
}

std::vector<Column> separate_columns(const std::vector<Chart>& charts) {
  std::vector<Column> columns;
  for (const Chart& chart : charts)
    for (const Curve& curve : chart.curves) {
      const std::string name = column_name(chart, curve, charts.size());
      Column x = {name + "_x", {}}, y = {name + "_y", {}};
      for (const CurvePoint& p : curve.points) {
        x.second.push_back(p.x);
        y.second.push_back(p.y);
      }
      columns.push_back(std::move(x));
      columns.push_back(std::move(y));
    }
  return columns;
}

}  // namespace

std::string charts_csv(const std::vector<Chart>& charts) {
  const bool outlines =
      std::ranges::any_of(charts, [](const Chart& chart) { return std::ranges::any_of(chart.curves, is_outline); });
  return columns_csv(outlines ? separate_columns(charts) : shared_columns(charts));
}

}  // namespace springproof
