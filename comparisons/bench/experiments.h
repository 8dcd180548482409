// Benchmark of whole built-in experiments: the run time of `springproof compare`.
#pragma once

#include "comparisons/bench/options.h"
#include "comparisons/bench/rows.h"

namespace springproof::bench {

/// Runs `springproof compare` case by case, one part at a time; rows are the wall time and the CPU time of each stage.
void bench_experiments(const BenchOptions& options, Findings& findings);

}  // namespace springproof::bench
