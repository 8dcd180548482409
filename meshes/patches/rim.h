// The rim of a patch: where it ends on the surface of the body.
#pragma once

#include <string>
#include <vector>

#include "meshes/mesh.h"

namespace springproof {

/// An edge of facets, between one that is in the patch and one that is not.
struct RimEdge {
  Vec3 a, b;        ///< its ends [m]
  double turn = 0;  ///< angle between the normals of the two facets [rad]; 0 where the patch lies within the body
};

/// The rim of a patch of the mesh; none where the patch is closed.
std::vector<RimEdge> rim_of(const Mesh& mesh, const Patch& patch);

/// Whether the patch ends at edges of the body only, where its surface turns by 30 degrees or more: then it ends at the
/// same place on every mesh of the body.
bool ends_at_edges(const std::vector<RimEdge>& rim);

/// Whether the patch ends at no edge of the body for more than half of its rim.
bool is_smooth(const std::vector<RimEdge>& rim);

/// Cuts the tetrahedra at the rims of these patches until no edge of a facet there is longer than `longest` [m]; away
/// from a rim they grow with the distance.  Where a held patch ends on a smooth surface, stresses grow as 1/sqrt(r) and
/// displacements err in proportion to the edges at the rim; a patch that ends at edges of the body for most of its rim
/// is left as it is.  The body stays the same.
void refine_rims(const std::vector<std::string>& patches, double longest, Mesh& mesh);

}  // namespace springproof
