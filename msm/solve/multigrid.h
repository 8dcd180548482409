// Geometric multigrid on lattices: the displacement form, for Poisson's ratios away from 1/2.
#pragma once

#include <Eigen/SparseCholesky>
#include <vector>

#include "msm/solve/block_matrix.h"
#include "msm/solve/cell_stiffness.h"
#include "msm/solve/hierarchy.h"

namespace springproof {

/// Assembles a level's matrix from one cell's stiffness: K(edge) is proportional to the edge; a cell filled in part
/// counts in part.
BlockMatrix assemble(const LatticeLevel& level, const CellMatrix& cell);

/// Sparse Cholesky of the free unknowns of a matrix.
class DirectSolver {
 public:
  /// Of a BlockMatrix or a symmetric Tangent.
  /// @return false if the matrix is not positive definite.
  template <class Matrix>
  bool factor(const Matrix& A, const std::vector<char>& fixed) {
    number_free(fixed);
    return factor_lower(A.lower_triangle(number_, unknowns()));
  }
  /// x = A^-1 b on the free unknowns, 0 on the fixed.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;
  int unknowns() const { return static_cast<int>(free_.size()); }
  int negative_pivots() const { return negative_; }  ///< number of negative eigenvalues (Sylvester)

 private:
  void number_free(const std::vector<char>& fixed);
  bool factor_lower(const Eigen::SparseMatrix<double>& L);

  std::vector<int> free_;
  std::vector<int> number_;
  int negative_ = 0;
  bool analysed_ = false;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt_;
};

/// Symmetric V-cycle: Chebyshev (fourth kind) over Jacobi, trilinear transfer, lattices of doubled edge below.
/// A lattice that `may_float` needs no hold of its own: its rigid motions are anchored softly.
/// Its smoother's eigenvalue bound is the largest of diag(K_cell)^-1 K_cell, rigorous on every lattice of such cells.
class Multigrid {
 public:
  Multigrid(std::vector<LatticeLevel> levels, const CellMatrix& cell, int smoothing_degree = 3, bool may_float = false);

  /// z = M^-1 r, symmetric positive definite.
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const { cycle(0, r, z); }
  const BlockMatrix& finest() const { return matrix_.front(); }

 private:
  void cycle(std::size_t level, const Eigen::VectorXd& r, Eigen::VectorXd& z) const;
  void smooth(std::size_t level, Eigen::VectorXd& r, Eigen::VectorXd& x, bool update_residual) const;

  std::vector<LatticeLevel> levels_;
  std::vector<BlockMatrix> matrix_;
  std::vector<Eigen::VectorXd> inverse_diagonal_;  ///< 0 on fixed unknowns
  double largest_eigenvalue_ = 0;
  int degree_ = 3;
  DirectSolver coarsest_;
};

}  // namespace springproof
