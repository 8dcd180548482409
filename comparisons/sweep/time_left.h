// Estimates how long a comparison still takes, from what is expected of its runs and the times of finished ones.
#pragma once

#include <array>
#include <mutex>
#include <optional>
#include <vector>

#include "comparisons/reference/run_keeper.h"

namespace springproof {

/// Parts of a run, by number; times are seconds since it began.  Safe from several threads.
class TimeLeft {
 public:
  /// The expected runs of each part, and how many parts run at once.
  TimeLeft(const std::vector<std::vector<RunCost>>& expected, int jobs);

  void started(std::size_t part, double now);

  /// A run of the part has ended and took so long [s]; empty: it was kept from before.
  void ran(std::size_t part, const RunCost& expected, std::optional<double> took, double now);

  void finished(std::size_t part);  ///< also: loaded from an earlier run

  /// Seconds left: what is expected of the runs that are left, at the rate of the finished runs of their kind, above
  /// all of the same part; the run at hand lasts at least half as long again as it has lasted.  Empty: nothing is left.
  std::optional<double> at(double now) const;

 private:
  struct Rate {
    double expected = 0, took = 0;          ///< of finished runs [s]
    double beside(double otherwise) const;  ///< took / expected, of short runs rather `otherwise`
  };
  struct Part {
    std::array<double, run_kinds> left = {};  ///< expected [s]
    std::array<Rate, run_kinds> rates = {};
    std::optional<double> since = {};  ///< when the run at hand began
  };
  double left_of(const Part& part, double now) const;

  mutable std::mutex mutex_;
  std::vector<Part> parts_;
  std::array<Rate, run_kinds> rates_ = {};
  int jobs_;
};

}  // namespace springproof
