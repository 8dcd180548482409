// Predictions against the truth of cases that were not used to make them.
#pragma once

#include <string>
#include <vector>

#include "comparisons/advise/measurement.h"
#include "comparisons/advise/pilot.h"

namespace springproof {

/// One held-out error beside its predictions.
struct Judged {
  Measurement truth;
  Prediction predicted;
};

/// Within a factor of 1.5, or both below the reference's uncertainty.
bool hit(const Measurement& truth, const Prediction& prediction);

/// Whether the truth lies in the range that the prediction states, or both are below the reference's uncertainty.
bool inside(const Measurement& truth, const Prediction& prediction);

/// Hits of all, and of those on lattices finer than the pilot's.
struct HitRate {
  int all = 0, hits = 0, inside = 0;
  int beyond = 0, beyond_hits = 0;
};
HitRate hit_rate(const std::vector<Judged>& judged);

/// Predicts the held-out rows of the cases whose names contain `name` (empty: all), each from its pilot.
std::vector<Judged> judge_predictions(const std::vector<Measurement>& held_out, const std::string& name,
                                      const PilotSize& size = {});

}  // namespace springproof
