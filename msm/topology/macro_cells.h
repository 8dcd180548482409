// Macro-cells: eight cubes of a lattice, whose 27 nodes carry a triquadratic displacement.
#pragma once

#include "meshes/voxels/cut_cells.h"
#include "msm/topology/network.h"

namespace springproof {

/// Of the 27 nodes of a macro-cell that in a corner of one of its eight cubes, x fastest.
constexpr int macro_node(int cube, int corner) {
  const auto [x, y, z] = hexahedron_corners[corner];
  return cube % 2 + x + 3 * (cube / 2 % 2 + y) + 9 * (cube / 4 + z);
}

/// The macro-cells of a block of cubes.
/// @param mesh a block of equal cubes: block_mesh()
/// @return one for every two cubes along each axis, the first from the lowest corner
/// @throws std::invalid_argument unless the body is a block of an even number of cubes along each axis.
std::vector<MacroCell> macro_cells_of(const Mesh& mesh);

/// The macro-cells of a cut body: a connected part of the body in two cubes along each axis is one.
struct CutMacroCells {
  std::vector<MacroCell> cells;
  std::vector<std::array<FilledPart, 8>> filled;  ///< of the eight cubes, x fastest; fraction 0: none
  std::vector<MacroFace> faces;                   ///< between cells that are connected there, unless both are full
  std::vector<std::array<int, 2>> place;          ///< per cell of the body: macro-cell, and which of its cubes
  NodalVectors points;                            ///< of the nodes [m]
};

/// @param body of cells of one size
/// @return its macro-cells; they share the nodes of a face through which they are connected
/// @throws std::invalid_argument if the body has cells of several sizes.
CutMacroCells macro_cells_of(const CutBody& body);

/// Macro-cells are for bodies at rest, in one process.
/// @param network of any model
/// @param what does not know them, for the message
/// @throws InputError if the network has macro-cells.
void require_no_macro_cells(const Network& network, const std::string& what);

}  // namespace springproof
