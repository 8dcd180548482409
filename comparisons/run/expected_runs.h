// What the runs of a part, and of the variations of a case with measured values, are expected to take, from their
// numbers of unknowns.
#pragma once

#include <vector>

#include "comparisons/prepare/prepared_case.h"
#include "comparisons/reference/run_keeper.h"
#include "problem/case_file/varied.h"

namespace springproof {

/// What a model of the case, all its networks, is expected to take on a lattice.
RunCost cost_of_model(const PreparedCase& prepared, const Lattice& lattice, std::size_t number,
                      const IsotropicMaterial& material);

/// The same of all runs of a part, without what fails.
std::vector<RunCost> expected_runs(const PreparedCase& prepared, const IsotropicMaterial& material);

double sum_of(const std::vector<RunCost>& runs);  ///< [s]

/// The same before the body is meshed, so that only the part's own machine has to mesh it; of a body of voxels rougher
/// still.
/// @throws InputError for models that there are not.
double unmeshed_seconds(const Experiment& experiment, const IsotropicMaterial& material);

// The variations of a case with measured values: its other load cases, and each with the inputs changed one by one.

/// All but the case as it is written; none of a case without measured values.
std::vector<Variation> variations(const Experiment& experiment);

/// The case of a variation, without what is not measured: its first model, with an input changed on the lattice
/// of fewest cells alone and without finite elements.
Experiment case_of(const Experiment& experiment, const Variation& variation);

/// What the runs of a variation's case are expected to take together.
RunCost cost_of_variation(const Experiment& experiment);

}  // namespace springproof
