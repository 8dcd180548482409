// Runs one case: every model and the reference, at one Poisson's ratio, measured by the same code.
#pragma once

#include <filesystem>

#include "comparisons/report/results.h"
#include "comparisons/run/prepared_case.h"

namespace springproof {

/// Runs everything for experiment.materials[material]; writes one VTU per run into `vtu_folder` (empty: none).
/// A solver that finds no result leaves a Run with ok = false and no rows.
Part run_part(const PreparedCase& prepared, std::size_t material, const std::filesystem::path& vtu_folder);

}  // namespace springproof
