// Benchmark of the static solver, against PETSc CG + GAMG and optimally damped dynamics.
#pragma once

#include "comparisons/bench/options.h"
#include "comparisons/bench/rows.h"

namespace springproof::bench {

/// Adds its rows one by one, so that an interrupted run keeps those measured before.
void bench_statics(const BenchOptions& options, Findings& findings);

}  // namespace springproof::bench
