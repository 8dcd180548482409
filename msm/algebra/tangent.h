// The stiffness of a model about a state: blocks between joined nodes, and what passes through a node's sum.
#pragma once

#include "msm/algebra/block_matrix.h"

namespace springproof {

/// One linear form per node over all unknowns, n x 3 n.
using NodalForms = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// K = local + outflow^T inflow.  The second term reaches the neighbours of neighbours and is kept as its two factors.
struct Tangent {
  BlockMatrix local;
  NodalForms inflow;   ///< dJ_n/dx of momentum dispersion; no rows: there is none
  NodalForms outflow;  ///< d(force)/dJ_n, with the sign of a stiffness
  bool symmetric = true;

  bool dispersive() const { return inflow.rows() > 0; }

  /// y = K x (vectors of 3 n).
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

  /// Diagonal entries, 3 n.
  Eigen::VectorXd diagonal() const;

  /// The 3x3 block of each node with itself.
  std::vector<Eigen::Matrix3d> node_blocks() const;

  /// The entries of the unknowns with number[i] >= 0, renumbered by it; of a symmetric K.
  Eigen::SparseMatrix<double> lower_triangle(const std::vector<int>& number, int unknowns) const;
};

}  // namespace springproof
