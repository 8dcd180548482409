#include "comparisons/reproduce/curves.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace springproof {

Curve against_nu(const PaperResults& results, const std::string& case_name, const std::string& model,
                 const std::string& measure, const Curve& look, const std::optional<Cells>& cells) {
  Curve curve = look;
  std::set<double> poisson_ratios;
  for (const Row& row : results.rows(case_name)) poisson_ratios.insert(row.poisson_ratio);
  for (double nu : poisson_ratios)
    if (const Row* row = results.row(case_name, model, nu, measure, cells); row && std::isfinite(row->value))
      curve.points.push_back({nu, row->value, row->spread});
  return curve;
}

Curve against_measure(const PaperResults& results, const std::string& case_name, double poisson_ratio,
                      const std::string& x, const std::string& y, const Curve& look, double factor) {
  Curve curve = look;
  for (const Row& row : results.rows(case_name)) {
    if (row.measure != y) continue;
    const Row* place = results.row(case_name, row.model, poisson_ratio, x, row.cells);
    if (!place || !std::isfinite(row.value)) continue;
    curve.points.push_back(
        {place->value, factor * row.value, row.spread ? std::optional(factor * *row.spread) : std::nullopt});
  }
  std::ranges::stable_sort(curve.points, [](const CurvePoint& a, const CurvePoint& b) { return a.x < b.x; });
  return curve;
}

Curve along_probes(const PaperResults& results, const std::string& case_name, const std::string& model,
                   double poisson_ratio, const std::string& component,
                   const std::vector<std::pair<double, std::string>>& probes, const Curve& look,
                   const std::optional<Cells>& cells, bool fem) {
  Curve curve = look;
  for (const auto& [x, probe] : probes) {
    const Row* row = results.row(case_name, model, poisson_ratio, "displacement." + probe + "." + component, cells);
    if (!row) continue;
    if (fem && row->reference) curve.points.push_back({x, *row->reference});
    if (!fem && std::isfinite(row->value)) curve.points.push_back({x, row->value, row->spread});
  }
  if (!curve.points.empty()) curve.points.insert(curve.points.begin(), CurvePoint{0, 0});
  return curve;
}

Curve along_line(const PaperResults& results, const std::string& case_name, const std::string& model, bool stress,
                 int component, bool exact, const Curve& look) {
  Curve curve = look;
  for (const LineRecord& line : results.lines(case_name)) {
    if (line.model != model) continue;
    const LineTensors& values =
        stress ? (exact ? line.exact_stress : line.stress) : (exact ? line.exact_strain : line.strain);
    for (std::size_t i = 0; i < line.distance.size() && 6 * i + 5 < values.size(); ++i)
      curve.points.push_back(
          {100 * line.distance[i] / line.distance.back(), values[6 * i + static_cast<std::size_t>(component)]});
    break;
  }
  return curve;
}

Curve level_band(double from, double to, double y, double spread, const std::string& label) {
  return {label, CurveStyle::band, {{from, y, spread}, {to, y, spread}}};
}

}  // namespace springproof
