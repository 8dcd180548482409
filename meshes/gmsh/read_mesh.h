// gmsh's mesh as ours.
#pragma once

#include <filesystem>

#include "meshes/gmsh/session.h"
#include "meshes/mesh.h"

namespace springproof {

/// The cells of a block of tetrahedra or hexahedra (their corners; hexahedra of 27 nodes keep them as Mesh::curved),
/// with the physical surfaces as patches, facets outward.  The grid is detected: then nodes and cells are numbered x
/// fastest and the nodes lie on the lattice.  Parts that share no node, but meet in nodes at one place, are joined
/// there; facets of physical surfaces that are not on the surface of the body are left out; both are noted.
/// @throws InputError if a cell is inverted, or the cells are several parts, or parts that meet in edges or points
/// only.
Mesh read_mesh(const std::filesystem::path& file, const ElementBlock& cells, std::vector<std::string>& notes);

/// A quadrilateral as two triangles, by the diagonal through its lowest number.
std::vector<std::array<std::size_t, 3>> triangles_of(const std::array<std::size_t, 4>& quadrilateral);

/// Tetrahedra, hexahedra, prisms and pyramids by their corners as tetrahedra: from a node in their middle, which is
/// added to the model, to the triangles of their facets.  Quadrilaterals are cut like those of cells on their other
/// side, or as triangles_of() does.
/// @throws InputError at cells of another kind.
ElementBlock split_into_tetrahedra(const std::filesystem::path& file, const std::vector<ElementBlock>& blocks);

}  // namespace springproof
