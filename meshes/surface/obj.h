// OBJ files: the points and facets of a surface.
#pragma once

#include <filesystem>
#include <string_view>

#include "meshes/surface/surface.h"

namespace springproof {

/// The facets of an OBJ file (Wavefront), polygons cut into triangles at their first corner; its groups (`g`, `o`) are
/// the parts of the surface if there are several.  Texture, normals, materials, lines and curves are left aside.
/// @throws InputError with the file and the line: no file, no facets, a coordinate that is no finite number, a facet of
///         fewer than three corners, or of a vertex that is not there.
Surface read_obj(const std::filesystem::path& file);

/// As read_obj, from the file's text; `file` is used for messages.
Surface parse_obj(std::string_view text, const std::filesystem::path& file);

}  // namespace springproof
