// The body as the mass-spring models take it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "meshes/mesh.h"
#include "msm/topology/region.h"
#include "problem/experiment.h"

namespace springproof {

struct LatticeBody {
  std::shared_ptr<const Mesh> mesh;      ///< hexahedra
  std::shared_ptr<const Region> region;  ///< the true body, which disordered networks fill; empty: the mesh's
  std::vector<std::string> notes;        ///< what is left out of the body, for the user
};

/// Meshes the gmsh script `geo`; with body.voxels into tetrahedra, whose place the cubes take.
/// @throws InputError for whatever is wrong with the body.
LatticeBody lattice_body(const std::filesystem::path& geo, const Body& body, const Cells& cells);

}  // namespace springproof
