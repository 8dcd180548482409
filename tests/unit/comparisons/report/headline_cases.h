// Cases made of errors alone, and their headline.
#pragma once

#include "comparisons/report/headline.h"
#include "support/sample_case.h"

namespace springproof::test {

struct Point {
  double nu;
  int cells;
  double error;
};

/// A case of one model with displacement errors alone.
inline CaseResult with_errors(const std::string& name, const std::string& model, const std::vector<Point>& points) {
  CaseResult c;
  c.experiment.name = name;
  c.experiment.models = {{model, {}, model, {}}};
  for (const Point& p : points) {
    const Cells cells = {p.cells, p.cells, p.cells};
    c.runs.push_back({{model, p.nu, cells}, "msm", "linear", true, "", "", 1, 0, 0, 0});
    c.rows.push_back({{model, p.nu, cells}, name, "linear", "displacement_error", p.error, "1", {}, 1e-4, p.error});
  }
  return c;
}

inline void add_row(CaseResult& c, const std::string& model, double nu, const std::string& measure, double error,
                    double uncertainty) {
  c.rows.push_back(
      {{model, nu, {10, 10, 10}}, c.experiment.name, "linear", measure, error, "1", 0.0, uncertainty, error});
}

/// Several models at one Poisson's ratio: {name, displacement error}.
inline CaseResult with_models(const std::string& name, double nu, double uncertainty,
                              const std::vector<std::pair<std::string, double>>& models) {
  CaseResult c;
  c.experiment.name = name;
  c.experiment.reference.elements = {"p2"};
  c.experiment.materials = {{1e4, nu, 1000}};
  for (const auto& [model, error] : models) {
    c.experiment.models.push_back({model, {}, model, {}});
    if (model.starts_with("msm_")) c.own_poisson_ratios[model] = 0.25;
    c.runs.push_back({{model, nu, {10, 10, 10}}, "msm", "linear", true, "", "", 1, 0, 0, 0});
    add_row(c, model, nu, "displacement_error", error, uncertainty);
  }
  c.references.push_back({nu, "displacement_error", "1", {}, {}, 1.5, 0, uncertainty, "Richardson, GCI", "p2"});
  return c;
}

}  // namespace springproof::test
