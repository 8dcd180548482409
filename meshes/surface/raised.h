// Facets that are moved across themselves.
#pragma once

#include <vector>

#include "meshes/surface/surface.h"

namespace springproof {

/// The surface with its points moved so that each facet rises by its height, as nearly as the facets at a point agree
/// (least squares by area): plane faces of height 0 and creases between them stay.
/// @param heights of the facets along their normals [m], as the surface's lengths
Surface raised(const Surface& surface, const std::vector<double>& heights);

}  // namespace springproof
