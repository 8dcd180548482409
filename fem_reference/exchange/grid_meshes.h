// Meshes for the grids of a request, of bodies given by a .geo.
#pragma once

#include "fem_reference/exchange/request.h"

namespace springproof::fem {

/// Meshes the .geo for every grid without a mesh, and adds the meshes to the request.  Blocks get few cells that are to
/// be refined, as geometric multigrid requires; other bodies the cells asked for, hexahedra with second-order edges, so
/// that curved surfaces stay curved.
/// @throws as mesh_geo()
void mesh_grids(Request& request);

}  // namespace springproof::fem
