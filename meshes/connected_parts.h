// Parts of a mesh: by common nodes, and by common facets.
#pragma once

#include "meshes/mesh.h"

namespace springproof {

/// Per node the lowest number of a node at its place.
/// @param X positions [m], n x 3
/// @param tolerance largest difference of a coordinate [m]
std::vector<int> coincident_nodes(const NodalVectors& X, double tolerance);

struct PartsByFacets {
  int count;   ///< of parts within which cells are connected through facets
  Vec3 hinge;  ///< a node that two of them share, if there are several [m]
};

PartsByFacets parts_by_facets(const Mesh& mesh);

}  // namespace springproof
