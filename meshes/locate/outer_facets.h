// The surface of a mesh, and the distance from it.
#pragma once

#include <array>
#include <vector>

#include "meshes/mesh.h"

namespace springproof {

struct OuterFacet {
  std::array<int, 4> key;    ///< node numbers, ascending; -1 first for a triangle
  std::array<int, 4> nodes;  ///< in order; -1 last for a triangle
  Vec3 cell_centre;          ///< of the cell behind it [m]
};

/// Facets that belong to one cell only, by ascending key.
std::vector<OuterFacet> outer_facets(const Mesh& mesh);

/// Point of a triangle nearest to p.
Vec3 closest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace springproof
