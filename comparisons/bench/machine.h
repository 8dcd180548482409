// The machine, and the measured limits of one core.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "comparisons/bench/kernels/bench_kernels.h"
#include "msm/kernels/instruction_set.h"

namespace springproof::bench {

/// A level of the memory as one core sees it.
struct MemoryLevel {
  std::string name;      ///< "L1", "L2", "L3", "DRAM"
  double bytes = 0;      ///< its size; of DRAM 0
  double GB_s = 0;       ///< read by one core; for DRAM that of the triad, counting the write-allocate read (32 bytes)
  double all_cores = 0;  ///< [GB/s] of DRAM, all cores at once; else 0
};

/// Peak arithmetic of one core with one instruction set.
struct Arithmetic {
  std::string instruction_set;        ///< "portable", "avx2", "avx512"
  double gflops64 = 0, gflops32 = 0;  ///< multiply-adds, two each
  double root64 = 0, root32 = 0;      ///< the inverse root of one number, as the kernels take it [ns]
};

struct Machine {
  std::string processor;
  int cores = 0;
  std::vector<Arithmetic> arithmetic;  ///< of each usable instruction set, the widest last; empty: not measured
  std::vector<MemoryLevel> memory;     ///< nearest first

  const Arithmetic& widest() const { return arithmetic.back(); }
  /// The nearest level that holds `bytes` with a tenth of its capacity to spare.
  const MemoryLevel& level_for(double bytes) const;
};

/// The bench's kernels for an instruction set of this processor.
BenchKernels kernels_of(InstructionSet set);

/// Name, cores and caches; no limits.
Machine this_machine();

/// Measures the limits [some 4 s; quick: 1 s].
void measure_limits(bool quick, Machine& machine);

nlohmann::json to_json(const Machine& machine);

}  // namespace springproof::bench
