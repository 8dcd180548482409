#include "msm/topology/hexagonal_lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

}  // namespace springproof
