#include "meshes/voxels/refined_grid.h"

namespace springproof {
namespace {

template <class Act>
void for_each_cube(const std::array<int, 3>& begin, const std::array<int, 3>& end, const Act& act) {
  for (int k = begin[2]; k < end[2]; ++k)
    for (int j = begin[1]; j < end[1]; ++j)
      for (int i = begin[0]; i < end[0]; ++i) act(std::array<int, 3>{i, j, k});
}

}  // namespace

VoxelGrid with_halved_cubes(const VoxelGrid& grid) {
  VoxelGrid fine{grid.origin, grid.edge / 2, {2 * grid.cells[0], 2 * grid.cells[1], 2 * grid.cells[2]}};
  fine.doubled.reserve(static_cast<std::size_t>(fine.cells[0]) * fine.cells[1] * fine.cells[2]);
  for_each_cube({0, 0, 0}, fine.cells, [&](const std::array<int, 3>& c) {
    const long above = cube_number(grid, {c[0] / 2, c[1] / 2, c[2] / 2});
    fine.doubled.push_back(static_cast<unsigned char>(1 + (grid.doubled.empty() ? 0 : grid.doubled[above])));
  });
  return fine;
}

void halve_cell(VoxelGrid& grid, const std::array<int, 3>& cube) {
  const int size = cell_size(grid, cube);
  if (size == 1) return;
  const auto [i, j, k] = cell_at(grid, cube);
  for_each_cube({i, j, k}, {i + size, j + size, k + size},
                [&](const std::array<int, 3>& c) { --grid.doubled[cube_number(grid, c)]; });
  for_each_cube({-1, -1, -1}, {2, 2, 2}, [&](const std::array<int, 3>& step) {
    const std::array<int, 3> beside = {i + size * step[0], j + size * step[1], k + size * step[2]};
    for (int d = 0; d < 3; ++d)
      if (beside[d] < 0 || beside[d] >= grid.cells[d]) return;
    if (cell_size(grid, beside) > size) halve_cell(grid, beside);
  });
}

}  // namespace springproof
