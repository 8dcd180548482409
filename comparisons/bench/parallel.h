// Lattices on several processes beside one process: strong and weak scaling, and memory.
#pragma once

#include "comparisons/bench/options.h"
#include "comparisons/bench/rows.h"

namespace springproof::bench {

/// springproof-lattice under mpirun on 2, 4, ... processes, as many as there are cores, and on one: a block in slabs in
/// equilibrium and in explicit steps, with the cells of one process (strong scaling) and with as many more (weak), and
/// a rabbit of cut cells in parts.  Wall seconds without set-up, the least of three runs that alternate.  A remark
/// instead of rows where a program is missing.
void bench_parallel(const BenchOptions& options, Findings& findings);

}  // namespace springproof::bench
