// How far the surfaces of gmsh's model lie above the facets of a mesh on them.
#pragma once

#include <vector>

#include "meshes/mesh.h"
#include "meshes/surface/surface.h"

namespace springproof {

/// Mean heights [file's units] of the model's surfaces above the outer facets of the mesh that gmsh just made on them,
/// exact for heights of second degree; 0 of others.
/// @param outside the mesh's outer facets, all of its nodes as points
/// @throws std::runtime_error where a surface has no parameters.
std::vector<double> heights_above(const Mesh& mesh, const Surface& outside);

}  // namespace springproof
