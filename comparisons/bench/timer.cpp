#include "comparisons/bench/timer.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "comparisons/bench/interrupt.h"

namespace springproof::bench {
namespace {

double seconds_of_sample(const Advance& advance, long steps, Clock clock) {
  const double start = seconds_of(clock);
  advance(steps);
  return seconds_of(clock) - start;
}

/// Number of steps that fill a sample; also warms up.
long steps_per_sample(const Advance& advance, const TimerOptions& options) {
  long steps = options.least_steps;
  for (double seconds;; steps *= 4) {
    seconds = seconds_of_sample(advance, steps, options.clock);
    if (seconds > options.sample / 8)
      return std::max(options.least_steps, std::lround(double(steps) * options.sample / seconds));
  }
}

}  // namespace

double seconds_of(Clock clock) {
  timespec t;
  clock_gettime(clock == Clock::thread ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

std::vector<double> least_seconds(const std::vector<Advance>& work, const TimerOptions& options) {
  std::vector<long> steps;
  for (const Advance& advance : work) steps.push_back(steps_per_sample(advance, options));
  std::vector<double> least(work.size(), std::numeric_limits<double>::infinity()), spent(work.size(), 0);
  for (bool more = true; more;) {
    more = false;
    for (std::size_t i = 0; i < work.size(); ++i) {
      if (spent[i] >= options.budget) continue;
      throw_if_interrupted();
      const double seconds = seconds_of_sample(work[i], steps[i], options.clock);
      least[i] = std::min(least[i], seconds / double(steps[i]));
      spent[i] += seconds;
      more = true;
    }
  }
  return least;
}

}  // namespace springproof::bench
