// Grids for cells of several sizes.
#pragma once

#include "meshes/voxels/voxelise.h"

namespace springproof {

/// The grid of cubes of half the edge with the same cells, so that all of them can be halved.
VoxelGrid with_halved_cubes(const VoxelGrid& grid);

/// Halves the edge of the cell that holds a cube, and those of neighbours, also over edges and corners, that would be
/// more than twice as large as the new ones.  A cell that is a cube stays.
void halve_cell(VoxelGrid& grid, const std::array<int, 3>& cube);

}  // namespace springproof
