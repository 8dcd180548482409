// The one volume formula: exact for trilinear hexahedra (faces ruled surfaces) and for tetrahedra, rest and deformed.
#pragma once

#include "meshes/mesh.h"

namespace springproof {

/// Volume [m^3] of a trilinear hexahedron with the given corners (gmsh order): integral of det J, exact.
double hexahedron_volume(const Eigen::Matrix<double, 8, 3>& x);
/// Volume [m^3] of a tetrahedron with the given corners; negative if it is inverted.
double tetrahedron_volume(const Eigen::Matrix<double, 4, 3>& x);

/// Volume [m^3] of every cell (hexahedra first, then tetrahedra) at node positions `x` (n x 3).
Eigen::VectorXd cell_volumes(const Mesh& mesh, const NodalVectors& x);

/// Volume [m^3] of the body at node positions `x`.
double volume(const Mesh& mesh, const NodalVectors& x);

/// dV/dx [m^2] at rest: the force of a unit pressure from within on each node, n x 3.
NodalVectors volume_gradient(const Mesh& mesh);

/// (V' - V) / V of the displaced body, exact [1].
double volume_change(const Mesh& mesh, const NodalVectors& displacement);

/// First-order volume change: integral of div u over V [1]; the trace of the mean strain.
double volume_change_first_order(const Mesh& mesh, const NodalVectors& displacement);

/// det(dx/dxi) [m^3] at each corner of a hexahedron, xi in the unit cube; all positive: the cell is not inverted.
std::array<double, 8> corner_jacobians(const Hexahedron& cell, const NodalVectors& x);

/// Smallest corner Jacobian determinant over all cells at node positions `x`, divided by its rest value; <= 0:
/// inverted.
double min_relative_jacobian(const Mesh& mesh, const NodalVectors& x);

}  // namespace springproof
