#include "msm/topology/node_lattice.h"

#include <cmath>
#include <cstdlib>

namespace springproof {
namespace {

/// Number of the cell at each place of the grid, -1 where there is none.
std::vector<int> cell_numbers(const Grid& grid) {
  std::vector<int> number(std::size_t(grid.cells[0]) * grid.cells[1] * grid.cells[2], -1);
  for (std::size_t c = 0; c < grid.cell_index.size(); ++c) {
    const auto [i, j, k] = grid.cell_index[c];
    number[(std::size_t(k) * grid.cells[1] + j) * grid.cells[0] + i] = static_cast<int>(c);
  }
  return number;
}

}  // namespace

Network node_lattice(const Mesh& mesh, const CubicPattern& pattern) {
  const double edge = cube_edge(mesh);
  const Grid& grid = *mesh.grid;
  const std::vector<int> number = cell_numbers(grid);
  const auto cell_at = [&](int i, int j, int k) {
    const bool in_grid = i >= 0 && j >= 0 && k >= 0 && i < grid.cells[0] && j < grid.cells[1] && k < grid.cells[2];
    return in_grid ? number[(std::size_t(k) * grid.cells[1] + j) * grid.cells[0] + i] : -1;
  };
  const double stiffness[4] = {0, pattern.k_e, pattern.k_f, pattern.k_c};  // by number of differing axes

  Network network;
  const auto nodes = static_cast<Eigen::Index>(grid.cell_index.size());
  network.X.resize(nodes, 3);
  network.cell_edge = edge;
  network.volume = Eigen::VectorXd::Constant(nodes, edge * edge * edge);
  std::vector<Spring> springs;
  for (int c = 0; c < nodes; ++c) {
    const auto [i, j, k] = grid.cell_index[c];
    network.X.row(c) = (grid.origin + edge * Vec3(i + 0.5, j + 0.5, k + 0.5)).transpose();
    for (int dk = -1; dk <= 1; ++dk)
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di) {
          const int axes = std::abs(di) + std::abs(dj) + std::abs(dk);
          const int other = cell_at(i + di, j + dj, k + dk);
          if (other > c && stiffness[axes] > 0)
            springs.push_back({c, other, stiffness[axes], edge * std::sqrt(double(axes))});
        }
  }
  network.springs = merge_springs(std::move(springs));
  return network;
}

}  // namespace springproof
