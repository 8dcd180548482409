// Period and amplitude of a recorded vibration.
#pragma once

#include <optional>
#include <vector>

#include "problem/relaxation.h"

namespace springproof {

struct Swings {
  double period = 0;     ///< mean, between the first and the last upward crossing of the mean [s]
  double amplitude = 0;  ///< mean over the swings between them, half of largest less smallest value
  double mean = 0;       ///< over these swings
  double begin = 0;      ///< the first of these crossings [s]
  int count = 0;
};

/// Of a quantity at ascending times; nothing with fewer than two swings, or fewer than eight samples to each.
std::optional<Swings> swings_of(const std::vector<double>& time, const std::vector<double>& value);

/// One mode of a damped vibration about a place of rest.
struct DampedSwings {
  double period = 0;         ///< of its zeros [s]
  double damping_ratio = 0;  ///< share of critical damping
};

/// The damped cosine, with a constant and the creep of each branch, that is nearest to the record from the first of
/// these swings on, by least squares: overtones, which peaks and crossings mix in, are nearly orthogonal to it. Nothing
/// if no such motion is found.
std::optional<DampedSwings> damped_swings_of(const std::vector<double>& time, const std::vector<double>& value,
                                             const Swings& swings, const Relaxation& creep = {});

/// When a quantity first departs from its first value by a tenth of its largest departure [s]; nothing if it is
/// constant.
std::optional<double> arrival_of(const std::vector<double>& time, const std::vector<double>& value);

}  // namespace springproof
