// Checks of a case that require its models or the patches of its body.
#pragma once

#include <string>
#include <vector>

#include "comparisons/prepare/prepared_case.h"
#include "comparisons/results/records.h"
#include "meshes/mesh.h"
#include "msm/parameters/model_table.h"
#include "problem/case_file/experiment.h"

namespace springproof {

/// @throws InputError at an expectation that has nothing to be compared with.
void check_expectations(const Experiment& experiment);

/// @throws InputError at an expectation or a published value of the mean displacement of a patch that the body lacks.
void check_mean_displacements(const Experiment& experiment, const std::vector<std::string>& patches);

/// @throws InputError naming both loads if two of them move one place of the surface differently, or if a force acts
///   only where others hold the body; `surface`: mesh of the body with its patches.
void check_supports(const Experiment& experiment, const Mesh& surface);

/// Of large displacements: every model of whole cells and every Poisson's ratio at which the lattice is not stable up
/// to 1.25 times the imposed strain, with free or with held sides.  Forces impose no strain that is known before.
std::vector<LatticeLimit> lattice_limits(const PreparedCase& prepared);

}  // namespace springproof
