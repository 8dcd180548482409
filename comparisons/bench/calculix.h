// Our finite elements beside CalculiX's: the same block on grids of equal numbers of unknowns, and at equal error.
#pragma once

#include "comparisons/bench/options.h"
#include "comparisons/bench/rows.h"

namespace springproof::bench {

/// CalculiX's quadratic bricks (C3D20, its direct solver) and our Q2 on two cases of small strain at nu = 0.25.  Two
/// rows each: CPU seconds of the whole programs where ours has at least as many unknowns, and where ours is coarse
/// enough that its error is just no larger.  Errors are those of displacements, against our grids of half the cell size
/// and their extrapolation.  A remark instead of rows where a program is missing.
void bench_calculix(const BenchOptions& options, Findings& findings);

}  // namespace springproof::bench
