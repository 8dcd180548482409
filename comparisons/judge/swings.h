// Period and amplitude of a recorded vibration.
#pragma once

#include <optional>
#include <vector>

namespace springproof {

struct Swings {
  double period = 0;         ///< mean, between the first and the last upward crossing of the mean [s]
  double amplitude = 0;      ///< mean over the swings between them, half of largest less smallest value
  double mean = 0;           ///< over these swings
  double damping_ratio = 0;  ///< share of critical damping, from the logarithmic decrement; 0 of a single swing
  int count = 0;
};

/// Of a quantity at ascending times; nothing with fewer than two swings, or fewer than eight samples to each.
std::optional<Swings> swings_of(const std::vector<double>& time, const std::vector<double>& value);

/// When a quantity first departs from its first value by a tenth of its largest departure [s]; nothing if it is
/// constant.
std::optional<double> arrival_of(const std::vector<double>& time, const std::vector<double>& value);

}  // namespace springproof
