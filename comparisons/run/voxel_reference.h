// The finite elements of a body of voxels: body-fitted tetrahedra, and hexahedra on the lattices' own cubes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "comparisons/run/reference_grids.h"

namespace springproof {

// Cubes of a lattice up to which they are also cut into eight, and up to which finite elements run on them at all: some
// million unknowns of elements with 27 and with 8 nodes.
inline constexpr std::size_t most_refined_cubes = 8000, most_cubes = 200000;

/// What solve_grids is for such a body.
ReferenceGrids solve_body_grids(const PreparedCase& prepared, const IsotropicMaterial& material);

/// What finite elements on the cubes of one lattice say: eight nodes as the lattice has them, and refined to the limit.
struct VoxelLimit {
  NodalVectors peer, limit;           ///< displacement at the lattice's nodes [m]
  Eigen::VectorXd nodal_uncertainty;  ///< of the limit [m]
  std::map<std::string, double> peer_values;
  std::map<std::string, ReferenceValue> limits;
};

/// Nothing if one of the grids has no result.
std::optional<VoxelLimit> voxel_limit(const PreparedCase& prepared, std::size_t lattice, const ReferenceGrids& grids);

/// The body-fitted limit at the nodes of a lattice.
struct BodyLimit {
  const ReferenceField& field;
  const std::map<std::string, ReferenceValue>& scalars;
};

/// Where the difference of one model from the body-fitted limit comes from; `u` and `values` one per sample.
std::vector<ErrorSplit> split_error(const PreparedCase& prepared, const Lattice& lattice, const RunKey& key,
                                    const VoxelLimit& voxels, const BodyLimit& body, const std::vector<NodalVectors>& u,
                                    const std::vector<std::map<std::string, double>>& values);

}  // namespace springproof
