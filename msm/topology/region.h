// The space that a disordered network fills.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "meshes/mesh.h"

namespace springproof {

/// A body as the set of its points.
struct Region {
  Vec3 lower;                                         ///< of the bounding box [m]
  Vec3 upper;                                         ///< of the bounding box [m]
  double volume;                                      ///< [m^3]
  std::function<bool(const Vec3&)> inside;            ///< boundary included, within 1e-12 of size()
  std::vector<Vec3> surface_points;                   ///< [m]; empty: no surface known
  std::vector<std::array<int, 3>> surface_triangles;  ///< anticlockwise seen from outside
  std::vector<Patch> patches = {};                    ///< by numbers of surface points

  /// Diagonal of the bounding box [m].
  double size() const { return (upper - lower).norm(); }
};

/// The body of a mesh.  Cells of a grid are looked up in constant time; any other mesh is bounded by its outer facets,
/// quadrilaterals cut into two triangles (curved edges are taken as straight).
/// @throws std::invalid_argument if the mesh has no cells.
Region region_of(const Mesh& mesh);

/// f(a, b, c) for pieces of the triangle that are no wider than `width` [m].
template <class F>
void for_pieces(const Vec3& a, const Vec3& b, const Vec3& c, double width, F f) {
  if (std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()}) <= width) return f(a, b, c);
  const Vec3 ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
  for_pieces(a, ab, ca, width, f);
  for_pieces(ab, b, bc, width, f);
  for_pieces(ca, bc, c, width, f);
  for_pieces(ab, bc, ca, width, f);
}

}  // namespace springproof
