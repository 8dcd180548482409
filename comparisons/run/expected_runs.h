// What the runs of a part are expected to take, from their numbers of unknowns.
#pragma once

#include <vector>

#include "comparisons/prepare/prepared_case.h"
#include "comparisons/reference/run_keeper.h"

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

/// What the runs of a variation's case (comparisons/run/variations.h) are expected to take together.
RunCost cost_of_variation(const Experiment& experiment);

}  // namespace springproof
