// Builds the finite element request of a case, and the meshes of its grids.
#pragma once

#include "fem_reference/exchange/request.h"
#include "problem/case_file/experiment.h"

namespace springproof::fem {

/// Body, solid of equilibria (Experiment::at_rest()), law and loads of the case; the caller adds grids and points.  The
/// tolerance is that of references, 1e-8.
/// @throws InputError if the body's script does not exist (find_geo).
Request request_of(const Experiment& experiment, const IsotropicMaterial& material);

/// Meshes the .geo for every grid without a mesh, and adds the meshes to the request.  Blocks get few cells that are to
/// be refined, as geometric multigrid requires; other bodies the cells asked for, hexahedra with second-order edges, so
/// that curved surfaces stay curved.
/// @throws as mesh_geo()
void mesh_grids(Request& request);

}  // namespace springproof::fem
