// Grids whose cells are halved at random.
#pragma once

#include <random>

#include "meshes/voxels/refined_grid.h"

namespace springproof::test {

/// Cells of the grid halved `rounds` times, each time `halved` of the smallest.
inline VoxelGrid halved_at_random(VoxelGrid grid, int rounds, int halved, unsigned seed = 1) {
  std::mt19937 bits(seed);
  for (int r = 0; r < rounds; ++r) {
    grid = with_halved_cubes(grid);
    for (int n = 0; n < halved;) {
      std::array<int, 3> cube;
      for (int d = 0; d < 3; ++d) cube[d] = static_cast<int>(bits() % static_cast<unsigned>(grid.cells[d]));
      if (r > 0 && cell_size(grid, cube) > 2) continue;
      halve_cell(grid, cube);
      ++n;
    }
  }
  return grid;
}

}  // namespace springproof::test
