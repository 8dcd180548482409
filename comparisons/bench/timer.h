// Timing of short pieces of work on a shared machine.
#pragma once

#include <functional>
#include <vector>

namespace springproof::bench {

/// Performs `steps` steps.
using Advance = std::function<void(long steps)>;

/// CPU time of the calling thread, or wall time (for work of several threads).
enum class Clock { thread, wall };

double seconds_of(Clock clock);

struct TimerOptions {
  double sample = 5e-3;  ///< about the length of one sample [s]
  double budget = 0.4;   ///< of all samples of one piece of work [s]
  Clock clock = Clock::thread;
  long least_steps = 1;  ///< of a sample
};

/// Seconds per step of each piece of work: the least over many short samples, interleaved, so that a ratio compares
/// simultaneous runs and disturbances of caches and clock rate by other programs cancel.  A sample has at least
/// `least_steps`, however long they take.
std::vector<double> least_seconds(const std::vector<Advance>& work, const TimerOptions& options = {});

}  // namespace springproof::bench
