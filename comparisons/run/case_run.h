// Runs one case: every model and the reference, at one Poisson's ratio, measured by the same code.
#pragma once

#include <filesystem>

#include "comparisons/report/results.h"
#include "comparisons/run/prepared_case.h"

namespace springproof {

/// Where VTU files go, and how.
struct VtuOutput {
  std::filesystem::path folder;  ///< empty: none
  bool single = false;           ///< in single precision
};

/// Name of the VTU file of a run, without its ending.
std::string vtu_stem(const RunKey& key);

/// Runs everything for experiment.materials[material]; writes one VTU per run.
/// A solver that finds no result leaves a Run with ok = false and no rows.
Part run_part(const PreparedCase& prepared, std::size_t material, const VtuOutput& vtu);

}  // namespace springproof
