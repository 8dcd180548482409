// Equilibrium: what the static solver costs, against PETSc CG + GAMG and optimally damped dynamics.
#pragma once

#include "comparisons/bench/options.h"
#include "comparisons/bench/rows.h"

namespace springproof::bench {

/// Adds its rows one by one, so that an interrupted run keeps those it has.
void bench_statics(const BenchOptions& options, Findings& findings);

}  // namespace springproof::bench
