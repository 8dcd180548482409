// Eigenvalues and eigenvectors of symmetric matrices, compiled once: a solver for another size, or in another source,
// takes the compiler seven seconds.  For hot loops over 3 x 3 matrices Eigen's computeDirect is the better choice.
#pragma once

#include <Eigen/Core>

namespace springproof {

/// Eigenvalues in ascending order; reads the lower triangle of an n x n matrix.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// Eigenvalues in ascending order and unit eigenvectors as columns.
struct Eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

Eigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& matrix);

/// Eigenpairs of the symmetric tridiagonal matrix with n diagonal and n - 1 off-diagonal values.
Eigenpairs tridiagonal_eigenpairs(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside);

}  // namespace springproof
