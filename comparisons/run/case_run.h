// Runs one case: every model and the reference, at one of its settings, measured by the same code.
#pragma once

#include "comparisons/prepare/prepared_case.h"
#include "comparisons/reference/run_keeper.h"
#include "comparisons/reference/vtu_output.h"
#include "comparisons/results/records.h"

namespace springproof {

/// Runs everything for one of experiment.settings(); writes one VTU per run.
/// A solver that finds no result leaves a Run with ok = false and no rows.  Where its runs are kept the models run
/// first, then the finite elements, the coarsest first, and what needs both is computed from what is kept.
Part run_part(const PreparedCase& prepared, std::size_t setting, const VtuOutput& vtu, const RunKeeper& keeper = {});

}  // namespace springproof
