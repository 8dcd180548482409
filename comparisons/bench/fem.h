// Benchmark of the finite element reference, with its ratios as rows.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "comparisons/bench/options.h"
#include "comparisons/bench/rows.h"

namespace springproof::bench {

/// Runs `springproof-fem --bench`, which prints its own table.  @return its JSON; null if the program is not found.
nlohmann::json bench_fem(const BenchOptions& options, Findings& findings);

}  // namespace springproof::bench
