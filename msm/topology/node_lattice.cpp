#include "msm/topology/node_lattice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

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
  network.cells.edge = edge;
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

Network node_lattice(const Region& region, double edge, double angle, const CubicPattern& pattern) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  const Vec3 size = region.upper - region.lower, middle = (region.upper + region.lower) / 2;
  const int high = std::max(1, static_cast<int>(std::lround(size.z() / edge)));
  int across = std::max(1, static_cast<int>(std::lround(size.x() / edge)));
  while (across * edge < size.head<2>().norm()) across += 2;  // with angle 0 the lattice that is not turned
  const Vec3 extent = edge * Vec3(across, across, high);
  const auto in_body = [&](const Vec3& p) -> Vec3 { return middle + turn * (p - extent / 2); };
  Mesh cubes = block_mesh(extent, {across, across, high});
  const std::vector<Hexahedron> all = std::move(cubes.hexahedra);
  const std::vector<std::array<int, 3>> places = std::move(cubes.grid->cell_index);
  cubes.hexahedra.clear();
  cubes.grid->cell_index.clear();
  for (std::size_t c = 0; c < all.size(); ++c) {
    const auto [i, j, k] = places[c];
    if (!region.inside(in_body(edge * Vec3(i + 0.5, j + 0.5, k + 0.5)))) continue;
    cubes.hexahedra.push_back(all[c]);
    cubes.grid->cell_index.push_back(places[c]);
  }
  if (cubes.hexahedra.empty()) throw std::invalid_argument("the turned lattice has no node in the body");
  Network network = node_lattice(cubes, pattern);
  for (Eigen::Index n = 0; n < network.X.rows(); ++n)
    network.X.row(n) = in_body(network.X.row(n).transpose()).transpose();
  return network;
}

}  // namespace springproof
