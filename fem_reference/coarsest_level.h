// What lies below the coarsest level of the matrix-free multigrid where that has many cells: a body of cubes.
#pragma once

#include <memory>

#include "fem_reference/elastic_system.h"

namespace springproof::fem {

/// Gives system.below: linear elements on `coarse`, the mesh that the system's cells were refined from (and its
/// vertices moved by `place`, if given), by Cholesky factors or algebraic multigrid.  For small strain, on one process.
void add_linear_coarse_space(const Mesh& coarse, const std::function<Vec3(const Vec3&)>& place, ElasticSystem& system);

}  // namespace springproof::fem
