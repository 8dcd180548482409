// Tetrahedra that no border of a shape runs through.
#pragma once

#include <vector>

#include "meshes/patches/cut_mesh.h"
#include "meshes/regions/solid_shape.h"

namespace springproof {

/// Cuts tetrahedra along the borders of a shape, so that each lies on one side.
/// @param longest edge that one may have in the shape before it is cut [m]; infinity: any
/// @param slack what is so near to a border is on it [m]
/// @return the numbers of those in the shape
std::vector<std::size_t> cut_along_borders(const SolidShape& shape, double longest, double slack, CutMesh& mesh);

}  // namespace springproof
