// Sparse Cholesky factorisation of a matrix on its free unknowns.
#pragma once

#include <Eigen/SparseCholesky>
#include <vector>

namespace springproof {

/// Number of free unknowns of a spring network up to which a factorisation is faster than an iterative solver.
inline constexpr long cholesky_limit = 3000;

class DirectSolver {
 public:
  /// Factors a BlockMatrix or a symmetric Tangent.
  /// @return false if the matrix is not positive definite: a pivot below `round_off` of the largest indicates a
  ///   mechanism, and the solution would be no equilibrium.
  template <class Matrix>
  bool factor(const Matrix& A, const std::vector<char>& fixed, double round_off = 1e-14) {
    number_free(fixed);
    return factor_lower(A.lower_triangle(number_, unknowns()), round_off);
  }
  /// x = A^-1 b on the free unknowns, 0 on the fixed.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;
  int unknowns() const { return static_cast<int>(free_.size()); }
  int negative_pivots() const { return negative_; }  ///< number of negative eigenvalues (Sylvester)

 private:
  void number_free(const std::vector<char>& fixed);
  bool factor_lower(const Eigen::SparseMatrix<double>& L, double round_off);

  std::vector<int> free_;
  std::vector<int> number_;
  int negative_ = 0;
  bool analysed_ = false;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt_;
};

}  // namespace springproof
