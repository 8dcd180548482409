// Coarse space below the coarsest level of the matrix-free multigrid, for coarsest levels with many cells: bodies of
// cubes, and quadratic tetrahedra.
#pragma once

#include <memory>

#include "fem_reference/system/elastic_system.h"

namespace springproof::fem {

/// Sets system.below: linear elements on `coarse`, the mesh from which the system's cells were refined (with vertices
/// moved by `place`, if given), or on the cells themselves if they have no levels, solved by Cholesky factors or
/// algebraic multigrid.  For small strain, on one process.
void add_linear_coarse_space(const Mesh& coarse, const std::function<Vec3(const Vec3&)>& place, ElasticSystem& system);

}  // namespace springproof::fem
