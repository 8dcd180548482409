#include "meshes/outer_facets.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace springproof {
namespace {

constexpr std::array<std::array<int, 3>, 4> tetrahedron_faces = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};

template <class Cell>
Vec3 centre_of(const Mesh& mesh, const Cell& cell) {
  Vec3 sum = Vec3::Zero();
  for (const int n : cell) sum += mesh.nodes.row(n).transpose();
  return sum / double(cell.size());
}

}  // namespace

std::vector<OuterFacet> outer_facets(const Mesh& mesh) {
  std::vector<OuterFacet> all;
  const auto add = [&](std::array<int, 4> nodes, const Vec3& centre) {
    auto key = nodes;
    std::sort(key.begin(), key.end());
    all.push_back({key, nodes, centre});
  };
  for (const Hexahedron& cell : mesh.hexahedra)
    for (int f = 0; f < 6; ++f) add(face_of(cell, f), centre_of(mesh, cell));
  for (const Tetrahedron& cell : mesh.tetrahedra)
    for (const auto& f : tetrahedron_faces) add({cell[f[0]], cell[f[1]], cell[f[2]], -1}, centre_of(mesh, cell));
  std::stable_sort(all.begin(), all.end(), [](const OuterFacet& a, const OuterFacet& b) { return a.key < b.key; });
  std::vector<OuterFacet> outer;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t j = i;
    while (j < all.size() && all[j].key == all[i].key) ++j;
    if (j == i + 1) outer.push_back(all[i]);
    i = j;
  }
  return outer;
}

// Ericson, Real-Time Collision Detection (2005), sec. 5.1.5: which of the seven Voronoi regions holds p.
Vec3 closest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
}

}  // namespace springproof
