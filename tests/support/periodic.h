// Periodic cells for homogenisation.
#pragma once

#include <cmath>
#include <limits>

#include "msm/periodic/homogenise.h"
#include "msm/topology/cubic_lattice.h"
#include "support/zoo.h"

namespace springproof::test {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// 3 x 3 x 3 cells of edge 1.
inline Network periodic_cubes(const CubicPattern& pattern) {
  Network network = cubic_lattice(block_mesh({3, 3, 3}, {3, 3, 3}), pattern);
  make_periodic({3, 3, 3}, network);
  return network;
}

/// The same with 26 springs per node and the nodes off their sites, so that they relax under strain.
inline Network jiggled_periodic_cubes() {
  Network network = periodic_cubes(isotropic_pattern(2));
  const NodalVectors moved = noise(network.X.rows(), 0.2);
  for (int n = 0; n < network.nodes(); ++n) network.X.row(n) += moved.row(network.master(n));
  for (Spring& s : network.springs) s.rest_length = (network.X.row(s.j) - network.X.row(s.i)).norm();
  return network;
}

/// Equilateral triangles with sides a and springs k: `rows` (even) rows of `columns` edges, thickness 1.
inline Network periodic_triangles(int columns, int rows, double a, double k) {
  const double height = a * std::sqrt(0.75);
  Network network;
  network.X.resize((rows + 1) * (columns + 1), 3);
  const auto node = [&](int i, int j) { return j * (columns + 1) + i; };
  std::vector<Spring> sides;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) network.X.row(node(i, j)) << a * (i + 0.5 * (j % 2)), height * j, 0;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      for (int up = 0; up < 2; ++up) {
        const int p = node(i, j), q = node(i + 1, j), r = node(i, j + 1), s = node(i + 1, j + 1);
        if (j % 2 == 0)
          network.triangles.push_back(up ? std::array{p, q, r} : std::array{q, s, r});
        else
          network.triangles.push_back(up ? std::array{p, q, s} : std::array{p, s, r});
      }
  network.volume = Eigen::VectorXd::Zero(network.X.rows());
  for (const auto& t : network.triangles)
    for (int c = 0; c < 3; ++c) {
      sides.push_back({t[c], t[(c + 1) % 3], k / 2, a});
      network.volume[t[c]] += a * height / 6;
    }
  network.springs = merge_springs(std::move(sides));
  make_periodic({columns * a, rows * height, 0}, network);
  return network;
}

}  // namespace springproof::test
