#include "msm/embedding/macro_shares.h"

#include <algorithm>
#include <array>
#include <map>

namespace springproof {
namespace {

/// Integrals of the three quadratic functions of an interval of two edges over its lower half, in edges.
constexpr double over_half[3] = {5.0 / 12, 2.0 / 3, -1.0 / 12};
/// Those over both halves.
constexpr double over_both[3] = {1.0 / 3, 4.0 / 3, 1.0 / 3};

std::array<int, 4> sorted(std::array<int, 4> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// A quarter of a face of a macro-cell: its nodes and their integrals over the quarter, in squared edges.
struct Quarter {
  std::array<int, 9> nodes;
  std::array<double, 9> integral;
  Vec3 normal;  ///< outward
};

/// Calls act(the four nodes of the quarter, ascending; the quarter) for the 24 quarters of a cell's faces.
template <class Act>
void for_each_quarter(const MacroCell& cell, const Act& act) {
  constexpr int stride[3] = {1, 3, 9};
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 2})
      for (const int s : {0, 1})
        for (const int t : {0, 1}) {
          const int along_s = stride[(axis + 1) % 3], along_t = stride[(axis + 2) % 3], origin = side * stride[axis];
          const auto node = [&](int i, int j) { return cell[origin + i * along_s + j * along_t]; };
          Quarter quarter{{}, {}, (side - 1) * Vec3::Unit(axis)};
          for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) {
              quarter.nodes[3 * j + i] = node(i, j);
              quarter.integral[3 * j + i] = over_half[s ? 2 - i : i] * over_half[t ? 2 - j : j];
            }
          act(sorted({node(s, t), node(s + 1, t), node(s, t + 1), node(s + 1, t + 1)}), quarter);
        }
}

}  // namespace

Embedding nodes_of_macro_cells(const Mesh& mesh, const Network& network) {
  Embedding e = nodes_of_mesh(mesh);
  const double l = network.cell_edge;
  std::map<std::array<int, 4>, std::vector<PatchShares*>> patches_of;  // by facet
  for (const Patch& p : mesh.patches) {
    PatchShares& shares = e.patches[p.name];
    shares = {Eigen::VectorXd::Zero(network.nodes()), NodalVectors::Zero(network.nodes(), 3)};
    for (const auto& facet : p.facets) patches_of[sorted(facet)].push_back(&shares);
  }
  e.volumes = Eigen::VectorXd::Zero(network.nodes());
  for (const MacroCell& cell : network.macro_cells) {
    for (int a = 0; a < 27; ++a)
      e.volumes[cell[a]] += l * l * l * over_both[a % 3] * over_both[a / 3 % 3] * over_both[a / 9];
    for_each_quarter(cell, [&](const std::array<int, 4>& facet, const Quarter& quarter) {
      const auto at = patches_of.find(facet);
      if (at == patches_of.end()) return;
      for (PatchShares* shares : at->second)
        for (int n = 0; n < 9; ++n) {
          shares->area[quarter.nodes[n]] += l * l * quarter.integral[n];
          shares->normal.row(quarter.nodes[n]) += l * l * quarter.integral[n] * quarter.normal.transpose();
        }
    });
  }
  return e;
}

}  // namespace springproof
