// Tetrahedra cut into eight, for meshes of one body that its file gives as cells.
#pragma once

#include "meshes/mesh.h"

namespace springproof {

/// Each tetrahedron cut into eight at the middles of its edges, the octahedron between them along its shortest
/// diagonal; each facet of a patch into four.  Materials stay with the parts.
/// @param mesh of tetrahedra
Mesh halved(const Mesh& mesh);

}  // namespace springproof
