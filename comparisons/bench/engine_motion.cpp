#include "comparisons/bench/engine_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace springproof::bench {
namespace {

/// Times at which the displacement passes through zero, linear between samples.
std::vector<double> passages(const std::vector<EngineSample>& samples, const Vec3& d) {
  const Vec3 rest = samples.front().tip;
  std::vector<double> times;
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    const double a = (samples[i].tip - rest).dot(d), b = (samples[i + 1].tip - rest).dot(d);
    if ((a < 0) != (b < 0)) times.push_back(samples[i].time + (samples[i + 1].time - samples[i].time) * a / (a - b));
  }
  return times;
}

/// Mean of the kinetic energy over [from, to] by the trapezoidal rule.
double mean_energy(const std::vector<EngineSample>& samples, double from, double to) {
  double sum = 0, time = 0;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    if (samples[i].time < from || samples[i + 1].time > to) continue;
    const double h = samples[i + 1].time - samples[i].time;
    sum += h * (samples[i].kinetic_energy + samples[i + 1].kinetic_energy) / 2;
    time += h;
  }
  return sum / time;
}

}  // namespace

std::optional<Vibration> vibration_of(const std::vector<EngineSample>& samples, const Vec3& d) {
  const std::vector<double> at = passages(samples, d);
  if (at.size() < 7) return {};
  double shortest = at.back(), longest = 0;
  for (std::size_t i = 0; i + 2 < at.size(); ++i) {
    shortest = std::min(shortest, at[i + 2] - at[i]);
    longest = std::max(longest, at[i + 2] - at[i]);
  }
  if (longest > 1.25 * shortest) return {};
  const double periods = double(at.size() - 1) / 2, period = (at.back() - at.front()) / periods;
  const double last = at.back() - period, first = at.front();
  const double decay =
      std::log(mean_energy(samples, first, first + period) / mean_energy(samples, last, last + period)) /
      (last - first);
  return Vibration{1 / period, decay * period / (4 * std::numbers::pi), periods};
}

double spin_kept(const std::vector<EngineSample>& samples) { return samples.back().spin[2] / samples.front().spin[2]; }

}  // namespace springproof::bench
