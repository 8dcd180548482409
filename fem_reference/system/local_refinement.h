// Tetrahedra that are cut where the error of a solution is largest.
#pragma once

#include <deal.II/dofs/dof_handler.h>

#include "fem_reference/system/elastic_system.h"
#include "meshes/mesh.h"

namespace springproof::fem {

/// The mesh with the longest edges of those cells bisected, once, that have the largest estimated errors, until there
/// are `most` cells: a cell's error is the distance of its strain's deviator from the mean of the cells of its material
/// at each corner (Zienkiewicz and Zhu 1987).
/// @param mesh that the body is of
/// @param displacement of second order, with current ghost values
/// @param shortest edge that a cut may leave [m]: under a point force, and at a rim, the error is never spread evenly
Mesh cut_where_errors_are_largest(const Mesh& mesh, const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                                  const DofVector& displacement, std::size_t most, double shortest);

}  // namespace springproof::fem
