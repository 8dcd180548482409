// Estimates how long a comparison takes, from its numbers of unknowns and the times of finished parts.
#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "comparisons/run/prepared_case.h"

namespace springproof {

/// Rough estimate of a part's time on one core [s], from the unknowns of its finite elements and springs.
double expected_seconds(const PreparedCase& prepared, const IsotropicMaterial& material);

/// The same before the body is meshed, so that only the part's own machine has to mesh it; of a body of voxels rougher
/// still.
/// @throws InputError for models that there are not.
double unmeshed_seconds(const Experiment& experiment, const IsotropicMaterial& material);

/// Parts of a run, by number; times are seconds since it began.  Safe from several threads.
class TimeLeft {
 public:
  /// The expected time of each part [s], and how many run at once.
  TimeLeft(std::vector<double> expected, int jobs);

  void started(std::size_t part, double now);
  void finished(std::size_t part, double now);
  void kept(std::size_t part);  ///< loaded from an earlier run

  /// Seconds left at the rate of the finished parts, and no faster than the running ones; empty: unknown.
  std::optional<double> at(double now) const;

 private:
  struct Part {
    double expected;
    std::optional<double> start = {}, took = {};
  };
  double rate(double now) const;

  mutable std::mutex mutex_;
  std::vector<Part> parts_;
  int jobs_;
};

}  // namespace springproof
