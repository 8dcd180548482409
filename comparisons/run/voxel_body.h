// Any closed body: tetrahedra for the finite elements, cubes cut out of it for the lattices.
#pragma once

#include "comparisons/run/prepared_case.h"
#include "meshes/field.h"

namespace springproof {

/// Meshes the body of a case, cuts its lattices and gives its loads the wrenches that they have on the true body, the
/// finest of the tetrahedral meshes.
/// @throws InputError for what is wrong with the body, its patches or its voxels.
void prepare_voxel_body(PreparedCase& prepared);

/// Displacement at the nodes of every lattice, one after the other, from that at body_points.
NodalVectors at_lattice_nodes(const PreparedCase& prepared, const NodalVectors& at_body_points);

/// Displacement at the measured points (comparisons/run/reference_grids.h) from that of a lattice's nodes.  A point of
/// a patch, and in a body of voxels a probe, may lie beyond the cells: it takes what the nearest one continues to.
/// @throws InputError naming a probe outside the body.
NodalVectors at_measured_points(const PreparedCase& prepared, const Lattice& lattice, const NodalVectors& displacement);

/// Torques as of forces about the rest centroids of the true body's patches instead of those of `own`.
std::vector<PatchReaction> about_true_patches(const PreparedCase& prepared, const Mesh& own,
                                              std::vector<PatchReaction> reactions);

}  // namespace springproof
