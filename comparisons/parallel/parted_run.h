// Any lattice or network on several processes, each with a part of its nodes.
#pragma once

#include <mpi.h>

#include <nlohmann/json.hpp>

#include "comparisons/parallel/parallel_case.h"

namespace springproof {

/// Linear equilibrium; results as `springproof-lattice --json` writes them, measures on the first process only.
nlohmann::json solve_in_parts(const ParallelCase& c, double tolerance, int max_iterations, MPI_Comm communicator);

}  // namespace springproof
