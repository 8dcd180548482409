// What a run costs, counted alike for every solver.
#pragma once

#include <algorithm>

namespace springproof {

double cpu_seconds();      ///< CPU time of the calling thread [s]
double peak_memory_MiB();  ///< largest resident memory of this program so far

/// CPU time of one run [s].
struct RunTimes {
  double set_up = 0;  ///< from the mesh in memory to a discrete system with its loads: network or degrees of freedom,
                      ///< moduli, supports
  double solve = 0;   ///< from there to the displacement: stiffness, preconditioner, iterations
};

// Runs whose times are compared stop at this relative residual.
inline constexpr double compared_residual = 1e-8;

/// The least times of a run that has taken `first` and is repeated by `again` until five or 0.2 s are over.
template <class Again>
RunTimes least_times(RunTimes first, const Again& again) {
  double spent = first.set_up + first.solve;
  for (int run = 1; run < 5 && spent < 0.2; ++run) {
    const RunTimes next = again();
    spent += next.set_up + next.solve;
    first = {std::min(first.set_up, next.set_up), std::min(first.solve, next.solve)};
  }
  return first;
}

/// By how much this program's resident memory grows, once unused memory has been given back.  Of the whole program: for
/// one run at a time.
class MemoryGrowth {
 public:
  MemoryGrowth();
  double most_MiB() const;  ///< since construction; 0 where the system does not tell

 private:
  double before_MiB_;
};

}  // namespace springproof
