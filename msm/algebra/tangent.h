// Tangent stiffness of a model at a given state: 3x3 blocks of coupled nodes and the factors of momentum dispersion.
#pragma once

#include "msm/algebra/block_matrix.h"

namespace springproof {

/// Linear forms over all unknowns, one or more per node: n x 3 n at rest.
using NodalForms = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// K = local + outflow^T inflow.  The second term couples neighbours of neighbours and is stored as its two factors.
struct Tangent {
  BlockMatrix local;      ///< between nodes that share a spring, a triangle or a cell [N/m]
  NodalForms inflow;      ///< dJ_n/dx of momentum dispersion, or dF_n/dx; no rows if the model has none
  NodalForms outflow;     ///< d(force)/dJ_n, with the sign of a stiffness
  bool symmetric = true;  ///< false for dispersion without an energy

  /// Whether the second term is there.
  bool dispersive() const { return inflow.rows() > 0; }

  /// y = K x (vectors of 3 n).
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

  /// Diagonal entries, 3 n.
  Eigen::VectorXd diagonal() const;

  /// The diagonal 3x3 block of each node.
  std::vector<Eigen::Matrix3d> node_blocks() const;

  /// Lower triangle of the submatrix of the unknowns with number[i] >= 0, renumbered by `number`; for a symmetric K.
  Eigen::SparseMatrix<double> lower_triangle(const std::vector<int>& number, int unknowns) const;
};

}  // namespace springproof
