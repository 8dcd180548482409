// A body as a set of equal cubes.
#pragma once

#include <functional>

#include "meshes/mesh.h"

namespace springproof {

/// The cubes of the box [0, size], cut into `cells`, whose centres `inside` holds.  `body` is any mesh of the body: each outer
/// facet gets the patches of the body's outer facet that is nearest to its middle (none, if that one has none).
/// The grid is set.
/// @throws std::invalid_argument if the cells are no cubes, none lies inside, the body reaches out of the box, or the cubes
///   fall into parts that share no node.
Mesh voxelise(const Vec3& size, const std::array<int, 3>& cells, const std::function<bool(const Vec3&)>& inside, const Mesh& body);

}  // namespace springproof
