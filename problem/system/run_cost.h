// CPU time and memory of a run, measured alike for every solver.
#pragma once

#include <algorithm>

namespace springproof {

double cpu_seconds();      ///< CPU time of the calling thread [s]
double peak_memory_MiB();  ///< peak resident set of this process so far

/// CPU time of one run [s].
struct RunTimes {
  double set_up = 0;  ///< from the mesh in memory to a discrete system with its loads: network or degrees of freedom,
                      ///< moduli, supports
  double solve = 0;   ///< from there to the displacement: stiffness, preconditioner, iterations
};

// Runs whose times are compared stop at this relative residual.
inline constexpr double compared_residual = 1e-8;

/// The shortest times of a run that took `first` and is repeated by `again`, up to five runs or 0.2 s in all.
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

/// Growth of this process's resident memory, after unused memory has been returned to the system.  It counts the whole
/// process: measure one run at a time.
class MemoryGrowth {
 public:
  MemoryGrowth();
  double most_MiB() const;  ///< since construction; 0 if the system does not report it

 private:
  double before_MiB_;
};

}  // namespace springproof
