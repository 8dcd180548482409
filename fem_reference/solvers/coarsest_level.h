// What assembled matrices do for matrix-free operators: a coarse space below the coarsest level of the multigrid, for
// coarsest levels with many cells (bodies of cubes, and quadratic tetrahedra), and factors for thin bodies.
#pragma once

#include <functional>

#include "fem_reference/system/elastic_system.h"

namespace springproof::fem {

/// Sets system.below: linear elements on `coarse`, the mesh from which the system's cells were refined (with vertices
/// moved by `place`, if given), or on the cells themselves if they have no levels, solved by Cholesky factors or
/// algebraic multigrid.  For small strain, on one process.
void add_linear_coarse_space(const Mesh& coarse, const std::function<Vec3(const Vec3&)>& place, ElasticSystem& system);

/// For bodies so thin that linear elements lock and are of no use below quadratic ones.  For small strain.
/// @param system with displacements of any degree; of the mixed form its shear part is factored
/// @return z = K^-1 r on unconstrained degrees of freedom by Cholesky factors of the assembled stiffness; nothing if it
///   has more than `most_factored_for_thin_bodies` rows
std::function<void(DofVector& z, const DofVector& r)> factored_stiffness(const ElasticSystem& system);

}  // namespace springproof::fem
