// What was measured of a run, beside the reference, as rows of results.csv.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "comparisons/run/part_run.h"

namespace springproof {

/// A row of a run of the case, without a measure.
Row blank_row(const PartRun& run, const RunKey& key, const std::string& kinematics);

/// Adds the rows of a model or element on a lattice.
/// @param u one displacement field per sample, at the lattice's nodes [m]
/// @param scalars the measures that have a value of their own, one set per sample
void add_rows(PartRun& run, std::size_t lattice, const std::string& model, const std::string& kinematics,
              const std::vector<NodalVectors>& u, const std::vector<std::map<std::string, double>>& scalars);

}  // namespace springproof
