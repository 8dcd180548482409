// The deformed surface of a field, for the report's 3D view.
#pragma once

#include "comparisons/report/results.h"
#include "meshes/field.h"

namespace springproof {

/// The outer facets of the field's own cells; of more than 20,000 triangles, fewer (thin_surface.h).
/// `truth`: displacement of the reference at the same nodes, or null (then no difference is given).
Picture picture(const RunKey& key, const Field& field, const NodalVectors* truth);

/// The true surface of a body, carried along by the voxels that stand for it: displacements, difference and volume
/// change are the trilinear ones of the nearest voxel, continued where the surface lies outside. `field`: of the voxels
/// (hexahedra); `body`: tetrahedra (or hexahedra), whose outer facets are the surface; `truth` as above, at the voxels'
/// nodes.
Picture smooth_picture(const RunKey& key, const Field& field, const Mesh& body, const NodalVectors* truth);

}  // namespace springproof
