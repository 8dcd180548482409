#include "msm/algebra/lobpcg.h"

#include <algorithm>

#include "msm/algebra/dense.h"

namespace springproof {
namespace {

constexpr double dependent =
    1e-12;  // of the largest eigenvalue of a Gram matrix of unit columns: a dependent direction

Eigen::MatrixXd product(const Operator& A, const Eigen::MatrixXd& X) {
  Eigen::MatrixXd Y(X.rows(), X.cols());
  Eigen::VectorXd y;
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    A(X.col(j), y);
    Y.col(j) = y;
  }
  return Y;
}

Eigen::MatrixXd beside(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  Eigen::MatrixXd both(A.rows(), A.cols() + B.cols());
  both << A, B;
  return both;
}

/// Unit columns in M; those without mass are left out.
Eigen::MatrixXd normalised(const Operator& M, const Eigen::MatrixXd& X) {
  const Eigen::VectorXd squares = X.cwiseProduct(product(M, X)).colwise().sum();
  Eigen::MatrixXd unit(X.rows(), X.cols());
  Eigen::Index kept = 0;
  for (Eigen::Index j = 0; j < X.cols(); ++j)
    if (squares[j] > 0) unit.col(kept++) = X.col(j) / std::sqrt(squares[j]);
  return unit.leftCols(kept);
}

}  // namespace

Eigen::MatrixXd orthonormalised(const Operator& M, Eigen::MatrixXd X, const Eigen::MatrixXd& to) {
  for (int pass = 0; pass < 2 && X.cols() > 0; ++pass) {  // the second removes the round-off of the first
    X = normalised(M, X);
    if (to.cols() > 0) X = normalised(M, X - to * (to.transpose() * product(M, X)));
    const Eigenpairs gram = symmetric_eigenpairs(X.transpose() * product(M, X));
    const Eigen::Index n = X.cols();
    Eigen::Index first = 0;
    while (first < n && !(gram.values[first] > dependent * gram.values[n - 1])) ++first;
    const Eigen::VectorXd scale = gram.values.tail(n - first).cwiseSqrt().cwiseInverse();
    X = X * gram.vectors.rightCols(n - first) * scale.asDiagonal();
  }
  return X;
}

SmallestEigenpairs smallest_eigenpairs(const Operator& K, const Operator& M, const Operator& precondition,
                                       const Eigen::MatrixXd& deflated, const Eigen::MatrixXd& start, int wanted,
                                       double tolerance, int max_iterations) {
  SmallestEigenpairs found;
  Eigen::MatrixXd& X = found.vectors;
  X = orthonormalised(M, start, deflated);
  const Eigen::Index block = X.cols();
  wanted = std::min(wanted, static_cast<int>(block));
  Eigen::MatrixXd others(X.rows(), 0);  // preconditioned residuals and the directions of the step before
  for (found.iterations = 0;; ++found.iterations) {
    // Rayleigh-Ritz in the span of X and the others.
    const Eigen::MatrixXd basis = beside(X, others), K_basis = product(K, basis);
    const Eigenpairs ritz = symmetric_eigenpairs(basis.transpose() * K_basis);
    const Eigen::MatrixXd C = ritz.vectors.leftCols(block);
    X = basis * C;
    found.values = ritz.values.head(block);
    const Eigen::MatrixXd directions = others * C.bottomRows(others.cols());
    // Residuals.
    const Eigen::MatrixXd MX = product(M, X);
    const Eigen::MatrixXd R = K_basis * C - MX * found.values.asDiagonal();
    Eigen::MatrixXd corrections(X.rows(), block);
    Eigen::Index open = 0;
    found.residual = 0;
    Eigen::VectorXd z;
    for (Eigen::Index j = 0; j < block; ++j) {
      const double residual = R.col(j).norm() / (std::abs(found.values[j]) * MX.col(j).norm());
      if (j < wanted) found.residual = std::max(found.residual, residual);
      if (residual <= tolerance) continue;
      corrections.col(open++) = R.col(j);
    }
    found.converged = found.residual <= tolerance;
    if (found.converged || found.iterations == max_iterations) break;
    for (Eigen::Index j = 0; j < open; ++j) {
      precondition(corrections.col(j), z);
      corrections.col(j) = z;
    }
    others = orthonormalised(M, beside(corrections.leftCols(open), directions), beside(deflated, X));
  }
  return found;
}

}  // namespace springproof
