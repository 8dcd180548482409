// Strain that alternates from cell to cell: wrinkles of a lattice, which no smooth displacement of a solid has.
#pragma once

#include "meshes/mesh.h"

namespace springproof {

/// Root mean squares of a displacement field.
struct Wrinkles {
  double alternating = 0;  ///< over pairs of neighbouring cells, of half the difference of their hourglass strains [1]
  double strain = 0;       ///< over cells, of all strain [1]

  double share() const { return strain > 0 ? alternating / strain : 0; }
};

/// The hourglass strain of a cell is what its corners do beyond an affine motion; bending has it too, but alike in
/// neighbours.  The share of a smooth field is of the order (edge over its length)^2; the wave (-1)^(i+j) across x and
/// y, in which the two diagonals of each face grow and shrink in turn (Golec et al. 2019, Figs. 3 and 6), has 0.8.  A
/// field whose strain is round-off of the positions, as of a body that flies, has none.
/// @param mesh of hexahedra
/// @param displacement of its nodes [m], n x 3
Wrinkles wrinkles(const Mesh& mesh, const NodalVectors& displacement);

}  // namespace springproof
