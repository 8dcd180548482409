// Sparse symmetric-pattern matrix of 3x3 blocks, one block row per node.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "msm/topology/network.h"

namespace springproof {

/// A block.
using Blocks = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// The stiffness of a network: block (i, j) couples the displacements of nodes i and j.
class BlockMatrix {
 public:
  BlockMatrix() = default;

  /// Pattern: for each node the nodes it couples to, ascending, itself included.
  explicit BlockMatrix(const std::vector<std::vector<int>>& coupled);

  /// The same for points of which some are carried: what is added in their rows and columns is handed to those that
  /// carry them, and theirs stay empty.  `coupled`: coupled_through() of the carriers.
  BlockMatrix(const std::vector<std::vector<int>>& coupled, Carriers carriers);

  /// Of a network's nodes.
  explicit BlockMatrix(const Network& network);

  /// Number of block rows.
  int nodes() const { return static_cast<int>(row_begin_.size()) - 1; }
  /// Number of stored blocks.
  std::size_t blocks() const { return blocks_.size(); }
  void set_zero();  ///< the pattern stays

  /// Adds to block (i, j), which must be in the pattern.
  void add(int i, int j, const Eigen::Matrix3d& block) {
    if (carriers_.empty() || (carriers_[i].empty() && carriers_[j].empty()))
      blocks_[find(i, j)] += block;
    else
      hand_on(i, j, block);
  }

  /// Block (i, j), which must be in the pattern.
  const Blocks& at(int i, int j) const { return blocks_[find(i, j)]; }

  /// y = A x (vectors of 3 n).
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

  /// Diagonal entries, 3 n.
  Eigen::VectorXd diagonal() const;

  /// Lower triangle of the submatrix of the unknowns with number[i] >= 0, renumbered by `number`.
  Eigen::SparseMatrix<double> lower_triangle(const std::vector<int>& number, int unknowns) const;

 private:
  std::size_t find(int i, int j) const;
  void hand_on(int i, int j, const Eigen::Matrix3d& block);

  std::vector<int> row_begin_ = {0};
  std::vector<int> column_;
  std::vector<Blocks> blocks_;
  Carriers carriers_;  ///< empty: no point is carried
};

/// For each node of a network the nodes that share a spring, a triangle, a cell or a bond with it, itself included,
/// ascending.
std::vector<std::vector<int>> coupled_nodes(const Network& network);

/// The pattern of the points that carry the others; a carried point couples to itself.
std::vector<std::vector<int>> coupled_through(const Carriers& carriers, const std::vector<std::vector<int>>& coupled);

/// The same for cells alone.
std::vector<std::vector<int>> coupled_nodes(int nodes, const std::vector<Hexahedron>& cells);

}  // namespace springproof
