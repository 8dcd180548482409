// PLY files: the points and facets of a surface.
#pragma once

#include <filesystem>

#include "meshes/surface/surface.h"

namespace springproof {

/// The facets of a PLY file, in words or binary, polygons cut into triangles at their first corner.
/// @throws InputError with the file: no file, none of PLY, no facets, a facet of fewer than three corners.
Surface read_ply(const std::filesystem::path& file);

}  // namespace springproof
