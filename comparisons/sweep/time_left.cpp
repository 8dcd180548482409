#include "comparisons/sweep/time_left.h"

#include <algorithm>

namespace springproof {

TimeLeft::TimeLeft(const std::vector<std::vector<RunCost>>& expected, int jobs)
    : parts_(expected.size()), jobs_(std::max(1, jobs)) {
  for (std::size_t part = 0; part < expected.size(); ++part)
    for (const RunCost& run : expected[part]) parts_[part].left[static_cast<std::size_t>(run.kind)] += run.seconds;
}

void TimeLeft::started(std::size_t part, double now) {
  const std::lock_guard lock(mutex_);
  parts_[part].since = now;
}

void TimeLeft::ran(std::size_t part, const RunCost& expected, std::optional<double> took, double now) {
  const std::lock_guard lock(mutex_);
  Part& p = parts_[part];
  const auto kind = static_cast<std::size_t>(expected.kind);
  p.left[kind] = std::max(0.0, p.left[kind] - expected.seconds);
  p.since = now;
  if (!took) return;
  for (Rate* rate : {&p.rates[kind], &rates_[kind]}) {
    rate->expected += expected.seconds;
    rate->took += *took;
  }
}

void TimeLeft::finished(std::size_t part) {
  const std::lock_guard lock(mutex_);
  parts_[part].left = {};
  parts_[part].since.reset();
}

double TimeLeft::Rate::beside(double otherwise) const {
  constexpr double weight = 1;  // [s]: runs as short as the start of a program say little
  return (weight * otherwise + took) / (weight + expected);
}

double TimeLeft::left_of(const Part& part, double now) const {
  double sum = 0;
  for (std::size_t kind = 0; kind < run_kinds; ++kind)
    sum += part.left[kind] * part.rates[kind].beside(rates_[kind].beside(1));
  if (!part.since) return sum;
  const double lasted = now - *part.since;
  return std::max(sum - lasted, lasted / 2);
}

std::optional<double> TimeLeft::at(double now) const {
  const std::lock_guard lock(mutex_);
  double sum = 0, longest = 0;
  for (const Part& p : parts_) {
    const double left = left_of(p, now);
    sum += left;
    longest = std::max(longest, left);
  }
  const double left = std::max(longest, sum / jobs_);
  if (left > 0) return left;
  return {};
}

}  // namespace springproof
