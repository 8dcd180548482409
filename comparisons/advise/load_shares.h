// How a body carries its load: the strain energy by its sections.
#pragma once

#include <string>

#include "meshes/mesh.h"
#include "problem/material.h"

namespace springproof {

/// Shares of a body's strain energy, by what the sections normal to an axis do: they move apart (axial), tilt
/// (bending), turn (torsion), slide (shear); the rest is strain that varies within a section (local), as beside
/// supports and in limbs.  The sum is 1.
struct LoadShares {
  double axial = 0, bending = 0, torsion = 0, shear = 0, local = 0;
  int axis = 0;  ///< 0: x

  std::string largest() const;  ///< of the first four, the load by which the body is classified
};

/// About the axis that leaves the least rest, of equals the shortest.  For a displacement [m] at the nodes of a mesh of
/// cubes (small strains).
LoadShares load_shares(const Mesh& mesh, const NodalVectors& displacement, const IsotropicMaterial& material);

}  // namespace springproof
