#include "comparisons/advise/check.h"

#include <algorithm>
#include <cmath>

#include "comparisons/advise/measure.h"
#include "comparisons/sweep/find_cases.h"

namespace springproof {
namespace {

constexpr double allowed_factor = 1.5;

bool both_below(const Measurement& truth, const Prediction& p) {
  return truth.error <= truth.uncertainty && p.error <= truth.uncertainty;
}

bool within(double truth, double predicted, double factor) {
  return truth > 0 && predicted > 0 && std::abs(std::log(predicted / truth)) <= std::log(factor);
}

const PilotModel* find_model(const Pilot& pilot, const std::string& label) {
  for (const auto* list : {&pilot.models, &pilot.elements})
    for (const PilotModel& m : *list)
      if (m.label == label) return &m;
  return nullptr;
}

/// The rows of a case at a Poisson's ratio, and the rows of the model table that they are of.
struct HeldOut {
  std::vector<Measurement> rows;
  std::vector<std::string> models;
};

HeldOut held_out_of(const std::vector<Measurement>& all, const std::string& name, double poisson_ratio) {
  HeldOut out;
  for (const Measurement& m : all) {
    if (m.case_name != name || !same_poisson_ratio(m.poisson_ratio, poisson_ratio)) continue;
    out.rows.push_back(m);
    const std::string row = m.model.substr(0, m.model.find(' '));
    if (!row.starts_with("fem_") && std::find(out.models.begin(), out.models.end(), row) == out.models.end())
      out.models.push_back(row);
  }
  return out;
}

}  // namespace

bool hit(const Measurement& truth, const Prediction& p) {
  return both_below(truth, p) || within(truth.error, p.error, allowed_factor);
}

bool inside(const Measurement& truth, const Prediction& p) {
  return both_below(truth, p) || within(truth.error, p.error, p.factor);
}

HitRate hit_rate(const std::vector<Judged>& judged) {
  HitRate out;
  for (const Judged& j : judged) {
    const bool good = hit(j.truth, j.predicted);
    ++out.all;
    out.hits += good;
    out.inside += inside(j.truth, j.predicted);
    out.beyond += j.predicted.beyond;
    out.beyond_hits += j.predicted.beyond && good;
  }
  return out;
}

std::vector<Judged> judge_predictions(const std::vector<Measurement>& held_out, const std::string& name,
                                      const PilotSize& size) {
  std::vector<Judged> out;
  for (const Experiment& e : held_out_cases()) {
    if (case_name(e.file).find(name) == std::string::npos) continue;
    for (const IsotropicMaterial& material : e.materials) {
      const HeldOut of = held_out_of(held_out, case_name(e.file), material.poisson_ratio);
      if (of.rows.empty()) continue;
      const Pilot pilot = solve_pilot(e, material, of.models, size);
      for (const Measurement& m : of.rows) {
        const bool whole = e.body.is_voxels() && !e.body.cut;
        const PilotModel* model = whole ? find_model(pilot, m.model + " cut=false") : nullptr;
        if (!model) model = find_model(pilot, m.model);
        if (model) out.push_back({m, predict(pilot, *model, m.cells)});
      }
    }
  }
  return out;
}

}  // namespace springproof
