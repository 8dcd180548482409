// A full block of cubes on several processes, in slabs across its last axis.
#pragma once

#include <mpi.h>

#include <nlohmann/json.hpp>
#include <string>

#include "comparisons/parallel/parallel_case.h"

namespace springproof {

/// Why a case cannot be shared out in slabs; empty: it can.
std::string why_no_slabs(const ParallelCase& c);

/// Linear equilibrium, displacement form; results as `springproof-lattice --json` writes them.
nlohmann::json solve_in_slabs(const ParallelCase& c, double tolerance, MPI_Comm communicator);

/// Explicit steps of the loaded block from rest, the supports moved at once; positions and velocities of the planes
/// beside a slab come from their owners after every step.
nlohmann::json move_in_slabs(const ParallelCase& c, long steps, double damping, MPI_Comm communicator);

}  // namespace springproof
