// Cells of any kind as tetrahedra that fit together.
#pragma once

#include "meshes/gmsh/session.h"

namespace springproof {

/// A quadrilateral as two triangles, by the diagonal through its lowest number.
std::vector<std::array<std::size_t, 3>> triangles_of(const std::array<std::size_t, 4>& quadrilateral);

/// Tetrahedra, hexahedra, prisms and pyramids by their corners as tetrahedra: from a node in their middle, which is
/// added to the model, to the triangles of their facets.  Quadrilaterals are cut like those of cells on their other
/// side, or as triangles_of() does.
/// @throws InputError at cells of another kind.
ElementBlock split_into_tetrahedra(const std::filesystem::path& file, const std::vector<ElementBlock>& blocks);

}  // namespace springproof
