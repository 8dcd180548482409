// Macro-cells: eight cubes of a lattice, whose 27 nodes carry a triquadratic displacement.
#pragma once

#include "msm/topology/network.h"

namespace springproof {

/// The macro-cells of a block of cubes.
/// @param mesh a block of equal cubes: block_mesh()
/// @return one for every two cubes along each axis, the first from the lowest corner
/// @throws std::invalid_argument unless the body is a block of an even number of cubes along each axis.
std::vector<MacroCell> macro_cells_of(const Mesh& mesh);

/// Macro-cells are for bodies at rest, in one process.
/// @param network of any model
/// @param what does not know them, for the message
/// @throws InputError if the network has macro-cells.
void require_no_macro_cells(const Network& network, const std::string& what);

}  // namespace springproof
