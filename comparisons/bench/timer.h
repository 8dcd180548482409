// Times of short pieces of work on a machine that others use too.
#pragma once

#include <functional>
#include <vector>

namespace springproof::bench {

/// Does so many steps.
using Advance = std::function<void(long steps)>;

/// Whose time counts: the calling thread's, or the clock on the wall (work of several threads).
enum class Clock { thread, wall };

double seconds_of(Clock clock);

struct TimerOptions {
  double sample = 5e-3;  ///< about the length of one sample [s]
  double budget = 0.4;   ///< of all samples of one piece of work [s]
  Clock clock = Clock::thread;
};

/// Seconds per step of each piece of work: the least over many short samples, taken in turn, so that a ratio of two is
/// of runs side by side and what others do to the caches and the clock rate falls out.  A step longer than a sample is
/// one.
std::vector<double> least_seconds(const std::vector<Advance>& work, const TimerOptions& options = {});

}  // namespace springproof::bench
