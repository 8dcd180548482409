// Files of surfaces: STL, ASCII and binary, OBJ and PLY.
#pragma once

#include <filesystem>
#include <string_view>

#include "meshes/surface/surface.h"

namespace springproof {

/// The facets of an STL file as they stand in it: three points each, not welded (check_surface does), normals ignored,
/// coordinates in the units of the file.  Several solids in one ASCII file are one surface, those with names its parts.
/// A file whose size is that of the count in bytes 80 to 83 is binary, whatever it begins with.
/// @throws InputError with the file and the line and column (ASCII) or facet (binary, from 1): no file, empty, no STL,
/// cut off, a count that
///         is not that of the file's size, coordinates that are no finite numbers, or, of 32 bits, too far from the
///         origin for the size of the body.
Surface read_stl(const std::filesystem::path& file);

/// As read_stl, from the file's bytes; `file` is used for messages.
Surface parse_stl(std::string_view bytes, const std::filesystem::path& file);

/// The facets of an OBJ file (Wavefront), polygons cut into triangles at their first corner; its groups (`g`, `o`) are
/// the parts of the surface if there are several.  Texture, normals, materials, lines and curves are left aside.
/// @throws InputError with the file and the line: no file, no facets, a coordinate that is no finite number, a facet of
///         fewer than three corners, or of a vertex that is not there.
Surface read_obj(const std::filesystem::path& file);

/// The facets of a PLY file, in words or binary, polygons cut into triangles at their first corner.
/// @throws InputError with the file: no file, none of PLY, no facets, a facet of fewer than three corners.
Surface read_ply(const std::filesystem::path& file);

}  // namespace springproof
