// Steps of lattices on the GPU against the same on this processor.
#pragma once

#include "comparisons/bench/options.h"
#include "comparisons/bench/rows.h"

namespace springproof::bench {

/// Explicit steps; a remark where there is no GPU.
void bench_gpu(const BenchOptions& options, Findings& findings);

}  // namespace springproof::bench
