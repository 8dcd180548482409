// Rows of the measure stress_error.
#pragma once

#include "comparisons/judge/measures.h"
#include "comparisons/models/model_run.h"
#include "comparisons/run/part_run.h"

namespace springproof {

/// Stresses of a model on a lattice at the points at which the reference's are compared.
ProbeStresses stresses_of(const PartRun& run, std::size_t lattice, const ModelParameters& parameters,
                          const std::array<NodalVectors, 2>& at_nodes);

/// The rows of a solution of finite elements that are compared; none: its stresses were not asked for.
ProbeStresses stresses_of(const PartRun& run, const ProbeStresses& solution);

/// Adds stress_error.von_mises, .hydrostatic and, where the reference's peaks converge, .peak, whose place is Row::of.
/// The reference is its finest grid, its uncertainty the step from the one before.
void add_stress_errors(PartRun& run, const RunKey& key, const std::string& kinematics, const ProbeStresses& stress);

}  // namespace springproof
