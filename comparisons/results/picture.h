// The deformed surface of a field, for the report's 3D view.
#pragma once

#include "comparisons/results/records.h"
#include "meshes/field.h"

namespace springproof {

/// The outer facets of the field's own cells; thinned to at most 20,000 triangles (thin_surface.h).  `truth`:
/// displacement of the reference at the same nodes, or null (then no difference is given).
Picture picture(const RunKey& key, const Field& field, const NodalVectors* truth);

/// The true surface of a body, deformed with the voxels that represent it: displacements, difference and volume change
/// are interpolated trilinearly in the nearest voxel, extrapolated where the surface lies outside. `field`: of the
/// voxels (hexahedra); `body`: tetrahedra (or hexahedra), whose outer facets are the surface; `truth` as above, at the
/// voxels' nodes.
Picture smooth_picture(const RunKey& key, const Field& field, const Mesh& body, const NodalVectors* truth);

/// Rest positions of the nodes of a picture of this mesh, in its order.
NodalVectors pictured_points(const Mesh& mesh);

}  // namespace springproof
