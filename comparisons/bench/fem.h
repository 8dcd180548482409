// The finite element reference's own bench, its ratios as rows.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "comparisons/bench/options.h"
#include "comparisons/bench/rows.h"

namespace springproof::bench {

/// Runs `springproof-fem --bench`, which prints its own table.  @return its JSON; null if the program is not there.
nlohmann::json bench_fem(const BenchOptions& options, Findings& findings);

}  // namespace springproof::bench
