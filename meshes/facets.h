// What facets and their edges are asked for; a facet has four nodes, a triangle three and -1 (Patch).
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "meshes/mesh.h"
#include "meshes/united_numbers.h"

namespace springproof {

inline int corners_of(const std::array<int, 4>& facet) { return facet[3] < 0 ? 3 : 4; }
inline int corners_of(const std::array<int, 3>&) { return 3; }

/// The edge from corner c to the next.
template <class Facet>
std::pair<int, int> edge_of(const Facet& facet, int c) {
  return std::minmax(facet[c], facet[(c + 1) % corners_of(facet)]);
}

/// What facets of the same nodes have in common.
template <class Facet>
Facet ascending(Facet nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

inline Vec3 middle_of(const Mesh& mesh, const std::array<int, 4>& facet) {
  Vec3 middle = Vec3::Zero();
  for (int c = 0; c < corners_of(facet); ++c) middle += mesh.nodes.row(facet[c]).transpose() / corners_of(facet);
  return middle;
}

/// Facets of a tetrahedron, outward by the right-hand rule.
inline std::array<std::array<int, 4>, 4> facets_of(const Tetrahedron& t) {
  const auto& [a, b, c, d] = t;
  return {{{a, c, b, -1}, {a, b, d, -1}, {b, c, d, -1}, {a, d, c, -1}}};
}

/// Unites numbers that have a key in common.
template <class Key>
void unite_by_key(std::vector<std::pair<Key, int>> keyed, UnitedNumbers& numbers) {
  std::sort(keyed.begin(), keyed.end());
  for (std::size_t i = 1; i < keyed.size(); ++i)
    if (keyed[i].first == keyed[i - 1].first) numbers.unite(keyed[i].second, keyed[i - 1].second);
}

/// Point of a segment nearest to p.
inline Vec3 closest_point(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  return a + std::clamp(along.dot(p - a) / along.squaredNorm(), 0.0, 1.0) * along;
}

/// Points as rows.
inline NodalVectors rows_of(const std::vector<Vec3>& points) {
  return Eigen::Map<const NodalVectors>(reinterpret_cast<const double*>(points.data()),
                                        static_cast<Eigen::Index>(points.size()), 3);
}

}  // namespace springproof
