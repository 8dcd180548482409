// Stresses at the points where the reference's are requested, and the rows of stress_error and stress_peak.
#pragma once

#include "comparisons/models/model_run.h"
#include "comparisons/run/part_run.h"

namespace springproof {

/// Those of a model on a lattice at stress_points().
/// @param of_nodes as recovered_stress() gives them
ProbeStresses at_stress_points(const PartRun& run, std::size_t lattice, const ModelParameters& parameters,
                               const NodalStresses& of_nodes);

/// Those of finite elements on a lattice; of trilinear ones on a block the means at nodes, in which alternating
/// pressures cancel, and trilinear between them.
ProbeStresses at_stress_points(const PartRun& run, std::size_t lattice, const fem::Solution& solution);

/// Finds the reference's and records how far its grids are off, if the case compares them.
/// @param doubt of its displacement
void build_stress_limit(PartRun& run, double doubt);

/// Adds stress_error.von_mises, .hydrostatic and .principal, and where the reference's peak has a limit stress_peak,
/// whose place is Row::of.
/// @param stress at stress_points()
void add_stress_errors(PartRun& run, const RunKey& key, const std::string& kinematics, const ProbeStresses& stress);

}  // namespace springproof
