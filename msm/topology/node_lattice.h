// Node-centred cubic lattices: a node in the middle of each cell.
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

}  // namespace springproof
