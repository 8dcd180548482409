#include "msm/solve/hierarchy.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace springproof {
namespace {

using Index = std::array<int, 3>;

/// Dense numbering of a box of lattice points; -1 = not in the body.
struct PointMap {
  Index size;
  std::vector<int> number;

  explicit PointMap(const Index& points) : size(points), number(std::size_t(points[0]) * points[1] * points[2], -1) {}
  bool holds(const Index& p) const {
    for (int d = 0; d < 3; ++d)
      if (p[d] < 0 || p[d] >= size[d]) return false;
    return true;
  }
  int& at(const Index& p) { return number[(std::size_t(p[2]) * size[1] + p[1]) * size[0] + p[0]]; }
  int get(const Index& p) const { return holds(p) ? const_cast<PointMap*>(this)->at(p) : -1; }
};

/// A level under construction: the lattice index of everything.
struct Indexed {
  Index cells_per_side;
  std::vector<Index> cell_index;
  std::vector<Index> node_index;
};

Indexed index_network(const Network& network) {
  const Grid& grid = *network.grid;
  Indexed indexed{grid.cells, grid.cell_index, std::vector<Index>(network.nodes())};
  for (std::size_t c = 0; c < network.cells.size(); ++c)
    for (int n = 0; n < 8; ++n)
      for (int d = 0; d < 3; ++d)
        indexed.node_index[network.cells[c][n]][d] = grid.cell_index[c][d] + hexahedron_corners[n][d];
  return indexed;
}

/// Fills cells, fill and parent of `coarse`; returns its indices and the numbers of its nodes.
std::pair<Indexed, PointMap> coarsen_cells(const Indexed& fine, const LatticeLevel& fine_level, LatticeLevel& coarse) {
  Indexed indexed;
  for (int d = 0; d < 3; ++d) indexed.cells_per_side[d] = (fine.cells_per_side[d] + 1) / 2;
  PointMap cell_number(indexed.cells_per_side);
  coarse.parent.resize(fine.cell_index.size());
  for (std::size_t c = 0; c < fine.cell_index.size(); ++c) {
    const Index at = {fine.cell_index[c][0] / 2, fine.cell_index[c][1] / 2, fine.cell_index[c][2] / 2};
    int& number = cell_number.at(at);
    if (number < 0) {
      number = static_cast<int>(indexed.cell_index.size());
      indexed.cell_index.push_back(at);
      coarse.fill.push_back(0);
    }
    coarse.parent[c] = number;
    coarse.fill[number] += fine_level.fill[c] / 8;
  }
  PointMap points({indexed.cells_per_side[0] + 1, indexed.cells_per_side[1] + 1, indexed.cells_per_side[2] + 1});
  coarse.cells.resize(indexed.cell_index.size());
  for (std::size_t c = 0; c < indexed.cell_index.size(); ++c)
    for (int n = 0; n < 8; ++n) {
      Index at = indexed.cell_index[c];
      for (int d = 0; d < 3; ++d) at[d] += hexahedron_corners[n][d];
      int& number = points.at(at);
      if (number < 0) {
        number = static_cast<int>(indexed.node_index.size());
        indexed.node_index.push_back(at);
      }
      coarse.cells[c][n] = number;
    }
  coarse.nodes = static_cast<int>(indexed.node_index.size());
  return {std::move(indexed), std::move(points)};
}

void set_weights(const Indexed& fine, const PointMap& coarse_points, LatticeLevel& coarse) {
  coarse.weight_begin = {0};
  for (const Index& at : fine.node_index) {
    for (int corner = 0; corner < 8; ++corner) {
      Index from;
      double weight = 1;
      for (int d = 0; d < 3; ++d) {
        const bool odd = at[d] % 2, upper = corner >> d & 1;
        from[d] = at[d] / 2 + upper;
        weight *= odd ? 0.5 : (upper ? 0.0 : 1.0);
      }
      if (weight == 0) continue;
      coarse.weight_node.push_back(coarse_points.get(from));
      coarse.weight.push_back(weight);
    }
    coarse.weight_begin.push_back(static_cast<int>(coarse.weight_node.size()));
  }
}

void set_fixed(const Indexed& fine, const std::vector<char>& fine_fixed, const Indexed& indexed, LatticeLevel& coarse) {
  PointMap fine_points({fine.cells_per_side[0] + 1, fine.cells_per_side[1] + 1, fine.cells_per_side[2] + 1});
  for (std::size_t n = 0; n < fine.node_index.size(); ++n) fine_points.at(fine.node_index[n]) = static_cast<int>(n);
  coarse.fixed.assign(3 * coarse.nodes, 0);
  for (int n = 0; n < coarse.nodes; ++n) {
    const Index at = {2 * indexed.node_index[n][0], 2 * indexed.node_index[n][1], 2 * indexed.node_index[n][2]};
    std::vector<int> sources;
    if (const int same = fine_points.get(at); same >= 0) {
      sources.push_back(same);
    } else {
      for (int k = 0; k < 27; ++k)
        if (const int near = fine_points.get({at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1}); near >= 0)
          sources.push_back(near);
    }
    for (int s : sources)
      for (int d = 0; d < 3; ++d) coarse.fixed[3 * n + d] |= fine_fixed[3 * s + d];
  }
}

}  // namespace

void LatticeLevel::prolongate(const Eigen::VectorXd& u, const std::vector<char>& fine_fixed,
                              Eigen::VectorXd& u_fine) const {
  const int fine_nodes = static_cast<int>(weight_begin.size()) - 1;
  u_fine.setZero(3 * fine_nodes);
  for (int n = 0; n < fine_nodes; ++n)
    for (int e = weight_begin[n]; e < weight_begin[n + 1]; ++e)
      u_fine.segment<3>(3 * n) += weight[e] * u.segment<3>(3 * weight_node[e]);
  for (std::size_t i = 0; i < fine_fixed.size(); ++i)
    if (fine_fixed[i]) u_fine[i] = 0;
}

void LatticeLevel::restrict_to(const Eigen::VectorXd& r_fine, const std::vector<char>& fine_fixed,
                               Eigen::VectorXd& r) const {
  const int fine_nodes = static_cast<int>(weight_begin.size()) - 1;
  r.setZero(3 * nodes);
  for (int n = 0; n < fine_nodes; ++n) {
    Vec3 value = r_fine.segment<3>(3 * n);
    for (int d = 0; d < 3; ++d)
      if (fine_fixed[3 * n + d]) value[d] = 0;
    for (int e = weight_begin[n]; e < weight_begin[n + 1]; ++e) r.segment<3>(3 * weight_node[e]) += weight[e] * value;
  }
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i]) r[i] = 0;
}

std::vector<LatticeLevel> lattice_levels(const Network& network, const std::vector<char>& fixed,
                                         int coarsest_unknowns, const std::vector<double>& fill) {
  if (!network.grid) throw std::invalid_argument("multigrid needs a network made from a lattice of cells");
  std::vector<LatticeLevel> levels(1);
  levels[0].nodes = network.nodes();
  levels[0].cells = network.cells;
  levels[0].fill = fill.empty() ? std::vector<double>(network.cells.size(), 1.0) : fill;
  levels[0].fixed = fixed;
  Indexed indexed = index_network(network);
  const auto shortest = [](const Indexed& i) { return *std::min_element(i.cells_per_side.begin(), i.cells_per_side.end()); };
  while (3 * levels.back().nodes > coarsest_unknowns && shortest(indexed) >= 2) {
    LatticeLevel coarse;
    coarse.edge_ratio = 2 * levels.back().edge_ratio;
    auto [coarse_indexed, points] = coarsen_cells(indexed, levels.back(), coarse);
    set_weights(indexed, points, coarse);
    set_fixed(indexed, levels.back().fixed, coarse_indexed, coarse);
    levels.push_back(std::move(coarse));
    indexed = std::move(coarse_indexed);
  }
  return levels;
}

}  // namespace springproof
