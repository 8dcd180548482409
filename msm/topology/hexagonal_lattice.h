// Planar networks of equilateral triangles, each node with six neighbours.
#pragma once

#include "msm/topology/network.h"

namespace springproof {

/// Rows along x through the bounding box of a mesh, in the plane of its mean z.  Whole rows fit the height, which sets
/// the edge to the value nearest to `edge` [m] (CellSet::edge); every other row is shifted by half an edge, so the
/// ends are staggered and the length is right to a quarter of an edge.  Each triangle gives its sides stiffness k/2,
/// with k = 1 N/m: the boundary has half springs.  Volume shares are the triangles' area times the box's height in z.
/// Kot et al. (2014), eq. (12): lambda = mu = 3 k / (4 sqrt 3) per thickness, plane stress.
/// @throws std::invalid_argument if the edge is not positive, or there would be more than 2e7 nodes.
Network hexagonal_lattice(const Mesh& mesh, double edge);

}  // namespace springproof
