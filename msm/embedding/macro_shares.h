// Shares of the nodes of macro-cells in the surface and the volume of a block.
#pragma once

#include "msm/embedding/embedding.h"

namespace springproof {

/// Embedding in a network of macro-cells whose nodes are the mesh's, in their order: nodes_of_mesh(), and the integrals
/// of the triquadratic interpolation over patches and body, exact.  A whole face of a macro-cell has shares of 1/36 at
/// its corners, 4/36 on its edges and 16/36 in its middle.
/// @param mesh a block of equal cubes
/// @param network with the macro-cells of the mesh
/// @return shares of patches and volumes set
Embedding nodes_of_macro_cells(const Mesh& mesh, const Network& network);

}  // namespace springproof
