// Finite element solutions for a body of voxels: body-fitted tetrahedra, and hexahedra on the lattices' own cubes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "comparisons/reference/reference_grids.h"

namespace springproof {

// Largest numbers of cubes of a lattice that are also cut into eight, and on which finite elements run at all: some
// million unknowns of elements with 27 and with 8 nodes.
inline constexpr std::size_t most_refined_cubes = 8000, most_cubes = 200000;

/// The counterpart of solve_grids for such a body.
ReferenceGrids solve_body_grids(const PreparedCase& prepared, const IsotropicMaterial& material,
                                const VtuOutput& vtu = {}, const RunKeeper& keeper = {},
                                const CoarsestField& coarsest = {});

/// Finite element results on the cubes of one lattice: of eight-node elements, and extrapolated to the limit of
/// refinement.
struct VoxelLimit {
  NodalVectors peer, limit;           ///< displacement at the lattice's nodes [m]
  Eigen::VectorXd nodal_uncertainty;  ///< of the limit [m]
  std::map<std::string, double> peer_values;
  std::map<std::string, ReferenceValue> limits;
};

/// Nothing if one of the grids has no result.
std::optional<VoxelLimit> voxel_limit(const PreparedCase& prepared, std::size_t lattice, const ReferenceGrids& grids);

/// Splits the difference of one model from the body-fitted limit by source; `u` and `values` one per sample.
std::vector<ErrorSplit> split_error(const PreparedCase& prepared, const Lattice& lattice, const RunKey& key,
                                    const VoxelLimit& voxels, const Reference& body, const std::vector<NodalVectors>& u,
                                    const std::vector<std::map<std::string, double>>& values);

/// Makes the split of a model of cut cells from that of the same model on whole cubes: no geometry, the same springs,
/// and the rest of the total as discretisation.
void without_staircase(const ErrorSplit& of_cubes, ErrorSplit& split);

}  // namespace springproof
