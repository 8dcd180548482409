// Lattices of springs without cells: cubic ones with a node in the middle of each cube, planar ones of triangles.
#pragma once

#include "msm/topology/cubic_lattice.h"
#include "msm/topology/region.h"

namespace springproof {

/// One node at the centre of each cell of a mesh of equal cubes, with the cell's volume; springs of the pattern, all at
/// full stiffness, between cells that share a face (k_e), an edge (k_f) or a corner (k_c).  Kot et al. (2014),
/// sec. 5.3. The surface lacks springs, so the magnitude of k must follow from calibrate(), which sums over the springs
/// present.
/// @throws std::invalid_argument as cube_edge().
Network node_lattice(const Mesh& mesh, const CubicPattern& pattern);

/// The same in a region: the cubes of a lattice turned by `angle` [rad] about the vertical through the middle of the
/// region's bounding box whose centres lie inside.
/// @throws std::invalid_argument if there is none.
Network node_lattice(const Region& region, double edge, double angle, const CubicPattern& pattern);

/// Rows along x through the bounding box of a mesh, in the plane of its mean z.  Whole rows fit the height, which sets
/// the edge to the value nearest to `edge` [m] (CellSet::edge); every other row is shifted by half an edge, so the
/// ends are staggered and the length is right to a quarter of an edge.  Each triangle gives its sides stiffness k/2,
/// with k = 1 N/m: the boundary has half springs.  Volume shares are the triangles' area times the box's height in z.
/// Kot et al. (2014), eq. (12): lambda = mu = 3 k / (4 sqrt 3) per thickness, plane stress.
/// @throws std::invalid_argument if the edge is not positive, or there would be more than 2e7 nodes.
Network hexagonal_lattice(const Mesh& mesh, double edge);

}  // namespace springproof
