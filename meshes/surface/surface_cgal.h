// What CGAL does for surface_check.cpp.
#pragma once

#include <utility>
#include <vector>

#include "meshes/surface/surface.h"

namespace springproof {

/// Pairs of facets of a welded surface that cut or touch each other elsewhere than at common points and edges; exact.
/// Stops at `most` pairs.  No facet may be without area.
std::vector<std::pair<int, int>> intersecting_facets(const Surface& surface, unsigned most);

}  // namespace springproof
