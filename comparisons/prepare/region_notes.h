// How well cells resolve the regions of a body.
#pragma once

#include <string>
#include <vector>

#include "meshes/mesh.h"
#include "problem/region.h"

namespace springproof {

/// What is worth knowing of regions in cells of an edge [m]: those less than two cells across or thin, and gaps between
/// them that are thinner than a cell.
/// @param regions of the body
/// @param body tetrahedra with materials
std::vector<std::string> region_notes(const std::vector<MaterialRegion>& regions, const Mesh& body, double edge);

/// @throws InputError at a region that is smaller than what a cell of this edge [m] keeps of a body.
void require_resolved(const std::vector<MaterialRegion>& regions, const Mesh& body, double edge);

/// @throws InputError at the smallest region, that it fills no cube enough.
[[noreturn]] void refuse_smallest(const std::vector<MaterialRegion>& regions, const Mesh& body, double edge);

}  // namespace springproof
