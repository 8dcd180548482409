// Test whether a point lies inside a closed triangulated surface.
#pragma once

#include <array>
#include <vector>

#include "meshes/locate/outer_facets.h"

namespace springproof {

/// Counts how often a ray along +z crosses the surface.  Triangles lie in buckets over the x-y plane; cells of a coarse
/// grid that no triangle meets are classified once.
struct RayParity {
  std::vector<Vec3> points;                   ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< closed: every edge belongs to an even number of triangles
  double tolerance = 0;                       ///< points within this distance of the surface are inside [m]

  Vec3 lower = Vec3::Zero(), edge = Vec3::Ones();  ///< of the grid [m]
  std::array<int, 3> count{};                      ///< buckets are the columns of this grid
  std::vector<int> bucket_start, bucket_items;     ///< triangles of a column
  std::vector<char> cell;                          ///< 0 outside, 1 inside, 2 meets the surface

  bool inside(const Vec3& p) const;
};

RayParity ray_parity(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles, double tolerance);

}  // namespace springproof
