// How long a comparison takes: guessed from its unknowns, corrected by the parts that are done.
#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "comparisons/run/prepared_case.h"

namespace springproof {

/// What a part takes on one core [s], from the unknowns of its finite elements and springs; a guess.
double expected_seconds(const PreparedCase& prepared, const IsotropicMaterial& material);

/// Parts of a run, by number; times are seconds since it began.  Safe from several threads.
class TimeLeft {
 public:
  /// What each part is expected to take, and how many run at once.
  TimeLeft(std::vector<double> expected, int jobs);

  void started(std::size_t part, double now);
  void finished(std::size_t part, double now);
  void kept(std::size_t part);  ///< was there already

  /// At the rate of the parts that are done, and no faster than those under way; empty: nothing is known.
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
