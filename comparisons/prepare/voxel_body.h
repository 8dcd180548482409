// Prepares any closed body: tetrahedra for the finite elements, cubes cut out of it for the lattices.
#pragma once

#include "comparisons/prepare/prepared_case.h"

namespace springproof {

/// Meshes the body of a case, cuts its lattices and sets the resultants of its loads on the true body, the finest of
/// the tetrahedral meshes.
/// @throws InputError for errors in the body, its patches or its voxels.
void prepare_voxel_body(PreparedCase& prepared);

/// Cut cells of a lattice that are measured at most: beyond, a finer lattice takes less time.
inline constexpr std::size_t most_measured_cells = 10000;

/// The cut cells of a lattice, to be measured in finer ones and on what the case's supports hold along all axes.
/// @throws std::invalid_argument if they are too many.
std::shared_ptr<MeasuredLattice> to_be_measured(const PreparedCase& prepared, const Lattice& lattice);

}  // namespace springproof
