// Resultants of a case's loads on the true body: on the facets of its file where it has such, else on the finest mesh.
#pragma once

#include "comparisons/prepare/prepared_case.h"
#include "meshes/field.h"

namespace springproof {

/// Whether nothing holds a body in motion: all of it falls alike, whatever its weight.
bool flies(const Experiment& experiment);

/// Sets the resultants of the loads [N, N m], the centroids of patches by rules, and by how much loads in proportion to
/// an area or a volume differ between the meshes.
void set_resultants(PreparedCase& prepared);

/// Reactions with torques about the rest centroids of the true body's patches instead of those of `own`.
std::vector<PatchReaction> about_true_patches(const PreparedCase& prepared, const Mesh& own,
                                              std::vector<PatchReaction> reactions);

}  // namespace springproof
