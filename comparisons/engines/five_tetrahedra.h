// Cubes of a lattice cut into tetrahedra.
#pragma once

#include <vector>

#include "meshes/mesh.h"

namespace springproof {

/// Five tetrahedra of each cube, of positive volume: one between every second corner, of a third of the volume, and one
/// at each of the other four corners.  Neighbours are mirror images of each other, so that their faces are cut along
/// the same diagonals and no direction is preferred.
/// @param X    nodes [m], n x 3
/// @param edge of the cubes [m], which are cells of one lattice along the axes
std::vector<Tetrahedron> five_tetrahedra(const NodalVectors& X, const std::vector<Hexahedron>& cells, double edge);

}  // namespace springproof
