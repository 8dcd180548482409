// How the loads of a motion depend on time.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace springproof {

/// Loads and moved supports are multiplied by factor(t); at most one of the three is not 0.
struct Course {
  double ramp = 0;       ///< they grow linearly over this time [s]; 0: they are there at once
  double pulse = 0;      ///< they last for this time, as half a sine wave [s]; 0: no pulse
  double frequency = 0;  ///< they are a sine wave of this frequency [Hz]; 0: no wave

  /// @param t time >= 0 [s]
  /// @return the factor at that time
  double factor(double t) const {
    if (pulse > 0) return t < pulse ? std::sin(std::numbers::pi * t / pulse) : 0;
    if (frequency > 0) return std::sin(2 * std::numbers::pi * frequency * t);
    return ramp > 0 ? std::min(1.0, t / ramp) : 1;
  }

  /// @param t time >= 0 [s]
  /// @return the integral of the factor from 0 to that time [s]
  double integral(double t) const {
    constexpr double pi = std::numbers::pi;
    if (pulse > 0) return pulse / pi * (t < pulse ? 1 - std::cos(pi * t / pulse) : 2);
    if (frequency > 0) return (1 - std::cos(2 * pi * frequency * t)) / (2 * pi * frequency);
    return t < ramp ? t * t / (2 * ramp) : t - ramp / 2;
  }

  /// @return the time from which the factor is constant [s]; infinity: there is none
  double settled() const { return frequency > 0 ? std::numeric_limits<double>::infinity() : std::max(ramp, pulse); }
};

}  // namespace springproof
