// A plane section through a body of several materials, for the report.
#pragma once

#include <string>

#include "meshes/mesh.h"

namespace springproof {

/// Colours of materials 0, 1, ...; again from the second on where there are more.
const char* material_colour(std::size_t material);

/// SVG of the section, across one of the axes and through the centroid of all regions, that shows most materials, and
/// of these most of the regions.  Each material is filled with its colour.
/// @param body with materials
std::string section_svg(const Mesh& body);

}  // namespace springproof
