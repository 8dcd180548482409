// Curves of results: what the charts of the table of figures are made of.
#pragma once

#include <string>
#include <vector>

#include "comparisons/reproduce/chart.h"
#include "comparisons/reproduce/paper_results.h"

namespace springproof {

/// A measure of one model against Poisson's ratio.
Curve against_nu(const PaperResults& results, const std::string& case_name, const std::string& model,
                 const std::string& measure, const Curve& look, const std::optional<Cells>& cells = {});

/// One point per model of the case: measure `y` over `x`, y times `factor`.
Curve against_measure(const PaperResults& results, const std::string& case_name, double poisson_ratio,
                      const std::string& x, const std::string& y, const Curve& look, double factor = 1);

/// A component of the displacement of probes on a line, from `begin`, where it is held: {x, probe}.  `fem`: the
/// converged finite elements in place of the model.
Curve along_probes(const PaperResults& results, const std::string& case_name, const std::string& model,
                   double poisson_ratio, const std::string& component,
                   const std::vector<std::pair<double, std::string>>& probes, const Curve& look,
                   const std::optional<Cells>& cells = {}, bool fem = false);

/// Component (xx yy zz xy yz xz: 0 to 5) of strain or stress along the case's line, against the place in per cent.
Curve along_line(const PaperResults& results, const std::string& case_name, const std::string& model, bool stress,
                 int component, bool exact, const Curve& look);

/// y = f(x) at `count` places of [from, to].
template <class Function>
Curve formula(double from, double to, const Curve& look, const Function& f, int count = 61) {
  Curve curve = look;
  for (int i = 0; i < count; ++i) {
    const double x = from + (to - from) * i / (count - 1);
    curve.points.push_back({x, f(x)});
  }
  return curve;
}

/// A band of half width `spread` around y, between two places.
Curve level_band(double from, double to, double y, double spread, const std::string& label);

}  // namespace springproof
