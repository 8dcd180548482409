#include "msm/topology/network.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace springproof {

Vec3 anchored_point(const Anchor& anchor, const NodalVectors& X) {
  Vec3 point = Vec3::Zero();
  for (int n = 0; n < 8; ++n) point += anchor.weights[n] * X.row(anchor.corners[n]).transpose();
  return point;
}

Vec3 gap(const InterfaceBond& bond, const NodalVectors& x) {
  Vec3 g = Vec3::Zero();
  for_each_corner(bond, [&](int node, double weight) { g += weight * x.row(node).transpose(); });
  return g;
}

std::vector<Spring> merge_springs(std::vector<Spring> springs) {
  int nodes = 0;
  for (Spring& s : springs) {
    if (s.i > s.j) std::swap(s.i, s.j);
    nodes = std::max(nodes, s.i + 1);
  }
  // Sorted by first node in linear time, and the few springs of a node by comparison.
  std::vector<std::size_t> end(nodes + 1, 0);
  for (const Spring& s : springs) ++end[s.i + 1];
  for (int i = 0; i < nodes; ++i) end[i + 1] += end[i];
  std::vector<Spring> sorted(springs.size());
  for (const Spring& s : springs) sorted[end[s.i]++] = s;
  springs.clear();
  for (std::size_t begin = 0, i = 0; i < static_cast<std::size_t>(nodes); begin = end[i++]) {
    std::stable_sort(sorted.begin() + begin, sorted.begin() + end[i],
                     [](const Spring& a, const Spring& b) { return a.j < b.j; });
    for (std::size_t s = begin; s < end[i]; ++s) {
      if (s == begin || springs.back().j != sorted[s].j) {
        springs.push_back(sorted[s]);
        continue;
      }
      if (std::abs(springs.back().rest_length - sorted[s].rest_length) > 1e-9 * sorted[s].rest_length)
        throw std::invalid_argument("springs between the same two nodes differ in rest length");
      springs.back().stiffness += sorted[s].stiffness;
    }
  }
  springs.shrink_to_fit();
  return springs;
}

Eigen::VectorXd volumes_by_mass(const Network& network) {
  const CellSet& cells = network.cells;
  if (cells.relative_densities.empty()) return network.volume;
  Eigen::VectorXd volume = Eigen::VectorXd::Zero(network.nodes());
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const int n : cells.corners[c])
      volume[n] += cells.relative_densities[cells.material(c)] * cells.shape(c).volume() / 8;
  hand_back(cells.carried, volume, 1);
  return volume;
}

Eigen::VectorXd masses(const Network& network, double density) {
  Eigen::VectorXd mass = density * volumes_by_mass(network);
  if (network.attached.size() > 0) mass += network.attached;
  return mass;
}

Eigen::VectorXd inverse_masses(const Network& network, double density) {
  Eigen::VectorXd inverse = masses(network, density).cwiseInverse();
  for (const CarriedPoint& c : network.cells.carried) inverse[c.point] = 0;
  return inverse;
}

std::vector<char> fixed_or_carried(const Network& network, std::vector<char> fixed) {
  for (const CarriedPoint& c : network.cells.carried) std::fill_n(fixed.begin() + 3 * c.point, 3, 1);
  for (const Anchor& a : network.anchors)
    for (int d = 0; d < 3; ++d)
      if (!a.acts(d)) fixed[3 * a.node + d] = 1;
  return fixed;
}

Eigen::Matrix<double, 24, 1> displacement_of(const Hexahedron& cell, const Network& network, const NodalVectors& x) {
  Eigen::Matrix<double, 24, 1> u;
  for (int n = 0; n < 8; ++n) u.segment<3>(3 * n) = (x.row(cell[n]) - network.X.row(cell[n])).transpose();
  return u;
}

}  // namespace springproof
