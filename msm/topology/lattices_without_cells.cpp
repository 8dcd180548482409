#include "msm/topology/lattices_without_cells.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace springproof {
namespace {

constexpr double most_nodes_of_sheet = 2e7;

/// Rows 0..rows; even rows have columns + 1 nodes, odd ones columns.
struct Rows {
  int rows, columns;

  int first(int row) const { return row * columns + (row + 1) / 2; }
  int node(int row, int i) const { return first(row) + i; }
};

/// Number of the cell at each place of the grid, -1 where there is none.
std::vector<int> cell_numbers(const Grid& grid) {
  std::vector<int> number(std::size_t(grid.cells[0]) * grid.cells[1] * grid.cells[2], -1);
  for (std::size_t c = 0; c < grid.cell_index.size(); ++c) {
    const auto [i, j, k] = grid.cell_index[c];
    number[(std::size_t(k) * grid.cells[1] + j) * grid.cells[0] + i] = static_cast<int>(c);
  }
  return number;
}

std::vector<std::array<int, 3>> triangles_of(const Rows& r) {
  std::vector<std::array<int, 3>> triangles;
  for (int row = 0; row < r.rows; ++row) {
    const bool long_below = row % 2 == 0;
    const auto below = [&](int i) { return r.node(row, i); };
    const auto above = [&](int i) { return r.node(row + 1, i); };
    for (int i = 0; i < r.columns; ++i)
      triangles.push_back(long_below ? std::array{below(i), below(i + 1), above(i)}
                                     : std::array{below(i), above(i + 1), above(i)});
    for (int i = 0; i + 1 < r.columns; ++i)
      triangles.push_back(long_below ? std::array{below(i + 1), above(i + 1), above(i)}
                                     : std::array{below(i), below(i + 1), above(i + 1)});
  }
  return triangles;
}

}  // namespace

Network hexagonal_lattice(const Mesh& mesh, double edge) {
  if (!(edge > 0)) throw std::invalid_argument(fmt::format("edge: {} m, must be positive", edge));
  const Vec3 lower = mesh.nodes.colwise().minCoeff(), size = mesh.nodes.colwise().maxCoeff().transpose() - lower;
  if (size[0] * size[1] / (edge * edge) > most_nodes_of_sheet)
    throw std::invalid_argument(fmt::format("edge: {:.3g} m makes too many nodes", edge));
  const int rows = std::max(1, static_cast<int>(std::lround(size[1] / (edge * std::sqrt(3.0) / 2))));
  const double height = size[1] / rows, a = height * 2 / std::sqrt(3.0);
  const int columns = std::max(1, static_cast<int>(std::lround(size[0] / a + 0.5)));
  const Rows grid{rows, columns};

  Network network;
  network.cells.edge = a;
  network.X.resize(grid.first(rows + 1), 3);
  const double start = lower[0] + (size[0] - columns * a) / 2;
  for (int row = 0; row <= rows; ++row)
    for (int n = grid.first(row); n < grid.first(row + 1); ++n)
      network.X.row(n) << start + a * (n - grid.first(row) + 0.5 * (row % 2)), lower[1] + height * row,
          lower[2] + size[2] / 2;
  network.triangles = triangles_of(grid);
  network.volume = Eigen::VectorXd::Zero(network.X.rows());
  std::vector<Spring> springs;
  for (const auto& t : network.triangles)
    for (int c = 0; c < 3; ++c) {
      network.volume[t[c]] += size[2] * a * height / 6;
      springs.push_back({t[c], t[(c + 1) % 3], 0.5, a});
    }
  network.springs = merge_springs(std::move(springs));
  return network;
}

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
