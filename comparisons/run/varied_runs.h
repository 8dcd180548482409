// The runs of a case under its other load cases, and with its inputs changed one by one.
#pragma once

#include <vector>

#include "comparisons/reference/run_keeper.h"
#include "comparisons/results/records.h"

namespace springproof {

/// Of the first model, and of the finite elements of the case where only the load case is another; with an input
/// changed on the coarsest lattice alone.  Only the rows that are measured, and turns.
/// Each is kept.  A change with which the case cannot be run is a run without rows, whose message says why.
/// @return none for a case without measured values
std::vector<VariedRun> varied_runs(const Experiment& experiment, const RunKeeper& keeper);

}  // namespace springproof
