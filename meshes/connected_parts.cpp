#include "meshes/connected_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "meshes/united_numbers.h"

namespace springproof {

std::vector<int> coincident_nodes(const NodalVectors& X, double tolerance) {
  using Place = std::array<long, 3>;
  std::map<Place, std::vector<int>> at;  // cubes of edge `tolerance` -> nodes without one at their place before them
  std::vector<int> same(static_cast<std::size_t>(X.rows()));
  for (int n = 0; n < static_cast<int>(same.size()); ++n) {
    same[n] = n;
    Place own;
    for (int d = 0; d < 3; ++d) own[d] = static_cast<long>(std::floor(X(n, d) / tolerance));
    for (int near = 0; near < 27 && same[n] == n; ++near) {
      const auto found = at.find({own[0] + near % 3 - 1, own[1] + near / 3 % 3 - 1, own[2] + near / 9 - 1});
      if (found == at.end()) continue;
      for (const int m : found->second)
        if ((X.row(n) - X.row(m)).cwiseAbs().maxCoeff() <= tolerance) same[n] = m;
    }
    if (same[n] == n) at[own].push_back(n);
  }
  return same;
}

PartsByFacets parts_by_facets(const Mesh& mesh) {
  const std::size_t cells = mesh.hexahedra.size() + mesh.tetrahedra.size();
  UnitedNumbers part(cells);
  std::map<std::array<int, 4>, int> first;  // a facet's nodes, ascending -> a cell
  std::vector<int> at_node(static_cast<std::size_t>(mesh.nodes.rows()), -1);
  int cell = 0;
  const auto visit = [&](std::array<int, 4> facet) {
    std::sort(facet.begin(), facet.end());
    if (const auto [at, is_new] = first.try_emplace(facet, cell); !is_new) part.unite(at->second, cell);
  };
  for (const Hexahedron& h : mesh.hexahedra) {
    for (int f = 0; f < 6; ++f) visit(face_of(h, f));
    ++cell;
  }
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    for (const std::array<int, 4>& facet : {std::array{a, b, c, -1}, {a, b, d, -1}, {a, c, d, -1}, {b, c, d, -1}})
      visit(facet);
    ++cell;
  }
  std::set<int> heads;
  for (int c = 0; c < static_cast<int>(cells); ++c) heads.insert(part.of(c));
  PartsByFacets parts{static_cast<int>(heads.size()), Vec3::Zero()};
  cell = 0;
  const auto look = [&](const auto& nodes) {
    for (const int n : nodes) {
      if (at_node[n] < 0) at_node[n] = cell;
      if (part.of(at_node[n]) != part.of(cell)) parts.hinge = mesh.nodes.row(n).transpose();
    }
    ++cell;
  };
  if (parts.count == 1) return parts;
  for (const Hexahedron& h : mesh.hexahedra) look(h);
  for (const Tetrahedron& t : mesh.tetrahedra) look(t);
  return parts;
}

}  // namespace springproof
