// gmsh's mesh as ours.
#pragma once

#include <filesystem>

#include "meshes/gmsh/session.h"
#include "meshes/mesh.h"

namespace springproof {

/// The cells of a block of tetrahedra or hexahedra (their corners; hexahedra of 27 nodes keep them as Mesh::curved),
/// with the physical surfaces as patches, facets outward.  The grid is detected: then nodes and cells are numbered x
/// fastest and the nodes lie on the lattice.
/// @throws InputError if a cell is inverted, the cells are several parts or a physical surface is not on the surface.
Mesh read_mesh(const std::filesystem::path& file, const ElementBlock& cells);

}  // namespace springproof
