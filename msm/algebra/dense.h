// Decompositions of dense matrices, compiled once: each takes the compiler five to thirteen seconds for another size,
// or in another source.  For hot loops over 3 x 3 matrices Eigen's own (computeDirect, ldlt) are the better choice.
#pragma once

#include <Eigen/Core>

namespace springproof {

/// Eigenvalues in ascending order; reads the lower triangle of an n x n matrix.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// Those of A x = lambda B x, B positive definite.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// Eigenvalues in ascending order and unit eigenvectors as columns.
struct Eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

Eigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& matrix);

/// Eigenpairs of the symmetric tridiagonal matrix with n diagonal and n - 1 off-diagonal values.
Eigenpairs tridiagonal_eigenpairs(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside);

/// X (n x k) of least norm among those that minimise |A X - B|, A m x n of the given rank, by QR decomposition.
struct LeastSquares {
  Eigen::MatrixXd X;
  Eigen::Index rank;
};

LeastSquares least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// A^-1 B for a symmetric semi-definite A, by LDL^T decomposition with pivots.
Eigen::MatrixXd symmetric_solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace springproof
