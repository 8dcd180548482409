// The surface of a body as triangles.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "meshes/box.h"
#include "meshes/locate/outer_facets.h"
#include "problem/vector.h"

namespace springproof {

/// Facets are outward by the right-hand rule where the surface is that of a body (surface_check.h).
struct Surface {
  std::vector<Vec3> points;                            ///< [m], or in the units of the file it was read from
  std::vector<std::array<int, 3>> triangles;           ///< numbers of points
  std::map<std::string, std::vector<int>> parts = {};  ///< that the file names: numbers of triangles
};

/// Outer facets of a mesh [m], quadrilaterals cut into two triangles; its points are all nodes.
Surface outside_of(const Mesh& mesh, const std::vector<OuterFacet>& facets);
inline Surface outside_of(const Mesh& mesh) { return outside_of(mesh, outer_facets(mesh)); }

/// Volume enclosed by a closed surface [m^3]; negative if its facets point inward.
double volume(const Surface& surface);

/// Centre of what a closed surface encloses.
Vec3 centroid(const Surface& surface);

/// Area of all facets [m^2].
double area(const Surface& surface);

/// Box around the points of the facets; low > high if there are none.
Box bounding_box(const Surface& surface);

}  // namespace springproof
