// Smaller tetrahedra where held patches end on a smooth surface.
#pragma once

#include <string>
#include <vector>

#include "meshes/mesh.h"

namespace springproof {

/// Cuts the tetrahedra at the rims of these patches until no edge of a facet there is longer than `longest` [m]; away
/// from a rim they grow with the distance.  Where a held patch ends on a smooth surface, stresses grow as 1/sqrt(r) and
/// displacements err in proportion to the edges at the rim; a patch that ends at edges of the body for most of its rim
/// is left as it is.  The body stays the same.
void refine_rims(const std::vector<std::string>& patches, double longest, Mesh& mesh);

}  // namespace springproof
