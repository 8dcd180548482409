// Prepares any closed body: tetrahedra for the finite elements, cubes cut out of it for the lattices.
#pragma once

#include "comparisons/prepare/prepared_case.h"
#include "meshes/field.h"

namespace springproof {

/// Meshes the body of a case, cuts its lattices and sets the resultants of its loads on the true body, the finest of
/// the tetrahedral meshes.
/// @throws InputError for errors in the body, its patches or its voxels.
void prepare_voxel_body(PreparedCase& prepared);

/// Reactions with torques about the rest centroids of the true body's patches instead of those of `own`.
std::vector<PatchReaction> about_true_patches(const PreparedCase& prepared, const Mesh& own,
                                              std::vector<PatchReaction> reactions);

}  // namespace springproof
