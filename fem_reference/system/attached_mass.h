// Consistent mass of what is hung on the body or glued to it.
#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <Eigen/Core>
#include <map>
#include <vector>

#include "fem_reference/grid/triangulate.h"
#include "problem/attached_mass.h"

namespace springproof::fem {

/// Per cell that has any, by its active index: integral of N_a N_b over the attached mass, of one component [kg].
/// @throws InputError naming the mass, if it is outside of the body or on a patch that there is not.
std::map<unsigned int, Eigen::MatrixXd> attached_mass(const std::vector<AttachedMass>& masses, const Body3& body,
                                                      const dealii::FiniteElement<3>& scalar);

}  // namespace springproof::fem
