#include "meshes/locate/outer_facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <utility>

namespace springproof {
namespace {

constexpr std::array<std::array<int, 3>, 4> tetrahedron_faces = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};

template <class Cell>
Vec3 centre_of(const Mesh& mesh, const Cell& cell) {
  Vec3 sum = Vec3::Zero();
  for (const int n : cell) sum += mesh.nodes.row(n).transpose();
  return sum / double(cell.size());
}

constexpr int faces_of(const Hexahedron&) { return 6; }
constexpr int faces_of(const Tetrahedron&) { return 4; }

std::array<int, 4> face(const Hexahedron& cell, int f) { return face_of(cell, f); }
std::array<int, 4> face(const Tetrahedron& cell, int f) {
  const auto& corners = tetrahedron_faces[f];
  return {cell[corners[0]], cell[corners[1]], cell[corners[2]], -1};
}

int lowest(const std::array<int, 4>& face) {
  const int first = std::min({face[0], face[1], face[2]});
  return face[3] < 0 ? first : std::min(first, face[3]);
}

/// The faces, `cell * faces + f`, in buckets by their lowest node: those of node n are items[start[n]] ...
/// items[start[n + 1] - 1].
template <class Cell>
void bucket_faces(const Mesh& mesh, const std::vector<Cell>& cells, std::vector<std::size_t>& start,
                  std::vector<std::uint32_t>& items) {
  const int faces = faces_of(Cell{});
  start.assign(mesh.nodes.rows() + 2, 0);
  for (const Cell& cell : cells)
    for (int f = 0; f < faces; ++f) ++start[lowest(face(cell, f)) + 2];
  for (std::size_t n = 2; n < start.size(); ++n) start[n] += start[n - 1];
  items.resize(cells.size() * faces);
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (int f = 0; f < faces; ++f)
      items[start[lowest(face(cells[c], f)) + 1]++] = static_cast<std::uint32_t>(c * faces + f);
}

/// A full sort of all faces would take most of the time of voxelising: buckets of a node hold a dozen.
template <class Cell>
void add_outer(const Mesh& mesh, const std::vector<Cell>& cells, std::vector<OuterFacet>& outer) {
  const int faces = faces_of(Cell{});
  std::vector<std::size_t> start;
  std::vector<std::uint32_t> items;
  bucket_faces(mesh, cells, start, items);
  std::vector<std::pair<std::array<int, 4>, std::uint32_t>> bucket;
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
    bucket.clear();
    for (std::size_t i = start[n]; i < start[n + 1]; ++i) {
      auto key = face(cells[items[i] / faces], items[i] % faces);
      std::sort(key.begin(), key.end());
      bucket.emplace_back(key, items[i]);
    }
    std::sort(bucket.begin(), bucket.end());
    for (std::size_t i = 0, j; i < bucket.size(); i = j) {
      for (j = i + 1; j < bucket.size() && bucket[j].first == bucket[i].first;) ++j;
      if (j > i + 1) continue;
      const Cell& cell = cells[bucket[i].second / faces];
      outer.push_back({bucket[i].first, face(cell, bucket[i].second % faces), centre_of(mesh, cell)});
    }
  }
}

}  // namespace

std::vector<OuterFacet> outer_facets(const Mesh& mesh) {
  std::vector<OuterFacet> outer;
  add_outer(mesh, mesh.tetrahedra, outer);  // their keys begin with -1
  add_outer(mesh, mesh.hexahedra, outer);
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
