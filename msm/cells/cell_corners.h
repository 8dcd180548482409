// Vectors at the corners of a cell, taken from those of all nodes and given back to them.
#pragma once

#include "msm/cells/filled_volume.h"

namespace springproof {

using Corners = Eigen::Matrix<double, 3, 8>;

/// The rows of `x` at the corners of a cell.
inline Corners corners_at(const Hexahedron& cell, const NodalVectors& x) {
  Corners p;
  for (int n = 0; n < 8; ++n) p.col(n) = x.row(cell[n]).transpose();
  return p;
}

/// Mean gradients of the corners' weights [1/m].
inline Corners gradients_at(const CellShape& cell) {
  const std::array<Vec3, 8> g = mean_gradients(cell);
  Corners gradient;
  for (int n = 0; n < 8; ++n) gradient.col(n) = g[n];
  return gradient;
}

/// f -= the derivative of an energy to the positions of the corners; of a force, 3 * corner + axis, likewise.
inline void subtract(const Corners& gradient, const Hexahedron& cell, NodalVectors& f) {
  for (int n = 0; n < 8; ++n) f.row(cell[n]) -= gradient.col(n).transpose();
}
inline void subtract(const Eigen::Matrix<double, 24, 1>& gradient, const Hexahedron& cell, NodalVectors& f) {
  for (int n = 0; n < 8; ++n) f.row(cell[n]) -= gradient.segment<3>(3 * n).transpose();
}

/// Derivative of F, 3 * column + row, to the positions of the corners, 3 * corner + axis.
inline Eigen::Matrix<double, 9, 24> slope_of_gradient(const Corners& gradient) {
  Eigen::Matrix<double, 9, 24> rows = Eigen::Matrix<double, 9, 24>::Zero();
  for (int n = 0; n < 8; ++n)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) rows(i + 3 * j, 3 * n + i) = gradient(j, n);
  return rows;
}

/// K += the stiffness of a cell.
inline void add_cell(const Eigen::Matrix<double, 24, 24>& of_cell, const Hexahedron& cell, BlockMatrix& K) {
  for (int m = 0; m < 8; ++m)
    for (int n = 0; n < 8; ++n) K.add(cell[m], cell[n], of_cell.block<3, 3>(3 * m, 3 * n));
}

}  // namespace springproof
