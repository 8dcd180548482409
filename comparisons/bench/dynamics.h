// Benchmark of explicit time steps: cost per spring, against LAMMPS and the plain loop over springs.
#pragma once

#include "comparisons/bench/machine.h"
#include "comparisons/bench/options.h"
#include "comparisons/bench/rows.h"

namespace springproof::bench {

/// Adds its rows one by one, so that an interrupted run keeps those measured before.
void bench_dynamics(const BenchOptions& options, const Machine& machine, Findings& findings);

}  // namespace springproof::bench
