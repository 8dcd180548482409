// Mean gradient and volume of the part of a cell that the body fills.
#pragma once

#include <array>

#include "msm/algebra/block_matrix.h"
#include "msm/topology/network.h"

namespace springproof {

/// Which side of the middle of its cell a corner lies on along an axis: -1 or 1.
inline double corner_side(int corner, int axis) { return 2.0 * hexahedron_corners[corner][axis] - 1; }

/// The matrix of the product v x.
inline Eigen::Matrix3d cross_matrix(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return m;
}

/// Mean over the filled part of the gradients of the corners' trilinear weights [1/m].
std::array<Vec3, 8> mean_gradients(const CellShape& cell);

/// Volume of the filled part of cell number `cell` [m^3].
double filled_volume(const Network& network, std::size_t cell);

/// Mean gradient of a nodal field over the filled part of a cell: of positions, F [1].
Eigen::Matrix3d mean_gradient(const Network& network, std::size_t cell, const NodalVectors& field);

/// Derivative of the volume of the filled part to the displacement of the corners [m^2]; 3 * corner + axis.
Eigen::Matrix<double, 24, 1> volume_gradient(const CellShape& cell);

/// Volume of the filled part by its mean deformation gradient, and its derivatives to the positions of the corners.
struct CellVolume {
  double value;                           ///< [m^3]
  Eigen::Matrix<double, 24, 1> gradient;  ///< [m^2]; 3 * corner + axis
};
/// Volume of the filled part of cell number `cell` at positions x [m].
CellVolume cell_volume(const Network& network, std::size_t cell, const NodalVectors& x);

/// K += pressure d2V/dx2 of that volume [N/m].
void add_volume_curvature(const Network& network, std::size_t cell, const NodalVectors& x, double pressure,
                          BlockMatrix& K);

/// Relative change of the volume of a network of cells, filled or cut, by the mean deformation gradients of the cells:
/// to first order in the displacement, and exact.
struct VolumeChange {
  double first_order;  ///< trace of the mean strain [1]
  double exact;        ///< (V' - V)/V [1]
};
/// Of displacements [m], n x 3.
VolumeChange volume_change(const Network& network, const NodalVectors& displacement);

}  // namespace springproof
