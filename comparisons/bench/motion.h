// Implementations of an explicit time step that can be timed.
#pragma once

#include <optional>
#include <string>

#include "comparisons/bench/machine.h"
#include "comparisons/bench/rows.h"
#include "comparisons/bench/timer.h"
#include "msm/dynamics/lattice_motion.h"
#include "msm/laws/laws.h"

namespace springproof::bench {

/// Minimum work of one step, counted as docs/measured/performance.md describes.
struct Work {
  double flops = 0;     ///< additions, multiplications, roots and divisions, each one
  double roots = 0;     ///< of them inverse roots: pairs of a root and a division
  double streamed = 0;  ///< bytes read and written, each array once per sweep
  double kept = 0;      ///< bytes of all arrays
};

/// Explicit steps of a network: forces and semi-implicit Euler.
struct TimedStep {
  std::string how;  ///< "forces(), AVX2", "plain loop"
  Advance advance;
  long nodes = 0, springs = 0;
  Work work = {};
  Precision precision = Precision::float64;
};

/// The library's fastest implementation for a model; empty if none supports these options.  The model must outlive it.
std::optional<TimedStep> fastest_motion(const MassSpringModel& model, const MotionOptions& options = {});

/// The straightforward baseline: one array of nodes {x, v, f}, one of springs of 24 bytes, a loop over each, compiled
/// for this processor.
TimedStep plain_motion(const Network& network);

/// Steps with forces(), by the loops that define the model's laws.  The model must outlive it.
TimedStep motion_by_forces(const MassSpringModel& model);

/// How well a motion that takes `seconds` per step uses one core.
Usage usage_of(const TimedStep& motion, double seconds, const Machine& machine);

}  // namespace springproof::bench
