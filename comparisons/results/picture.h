// The deformed surface of a field, for the report's 3D view, and a plane section through a body of several materials.
#pragma once

#include <array>
#include <vector>

#include "comparisons/results/records.h"
#include "meshes/field.h"
#include "problem/vector.h"

namespace springproof {

/// The outer facets of the field's own cells; thinned to at most 20,000 triangles (thinned()).  `truth`:
/// displacement of the reference at the same nodes, or null (then no difference is given).
Picture picture(const RunKey& key, const Field& field, const NodalVectors* truth);

/// The true surface of a body, deformed with the voxels that represent it: displacements, difference and volume change
/// are interpolated trilinearly in the nearest voxel, extrapolated where the surface lies outside. `field`: of the
/// voxels (hexahedra); `body`: tetrahedra (or hexahedra), whose outer facets are the surface; `truth` as above, at the
/// voxels' nodes.
Picture smooth_picture(const RunKey& key, const Field& field, const Mesh& body, const NodalVectors* truth);

/// Rest positions of the nodes of a picture of this mesh, in its order.
NodalVectors pictured_points(const Mesh& mesh);

/// The facets (triangles: fourth number -1) unchanged if they make at most `most` triangles; else at most `most`
/// triangles between fewer of the same points [m]: of the points in a cube of a lattice the one nearest to their mean
/// represents all.  Features thinner than a cube may be lost; for display only.
std::vector<std::array<int, 4>> thinned(const NodalVectors& points, const std::vector<std::array<int, 4>>& facets,
                                        std::size_t most = 20000);

/// Colours of materials 0, 1, ...; again from the second on where there are more.
const char* material_colour(std::size_t material);

/// SVG of the section, across one of the axes and through the centroid of all regions, that shows most materials, and
/// of these most of the regions.  Each material is filled with its colour.
/// @param body with materials
std::string section_svg(const Mesh& body);

}  // namespace springproof
