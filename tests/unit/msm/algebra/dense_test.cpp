// Decompositions against matrices whose answers are known.
#include "msm/algebra/dense.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace springproof::dense_test {
namespace {

/// Second differences, n x n: eigenvalues 2 - 2 cos(k pi / (n + 1)).
Eigen::MatrixXd second_differences(int n) {
  Eigen::MatrixXd A = 2 * Eigen::MatrixXd::Identity(n, n);
  A.diagonal(1).setConstant(-1);
  A.diagonal(-1).setConstant(-1);
  return A;
}

TEST(Dense, EigenvaluesAreThoseOfSecondDifferences) {
  const int n = 12;
  const Eigen::MatrixXd A = second_differences(n);
  const Eigen::VectorXd mass = Eigen::VectorXd::LinSpaced(n, 1, 3);
  const Eigen::MatrixXd root = mass.cwiseSqrt().asDiagonal();
  const Eigen::VectorXd own = symmetric_eigenvalues(A),
                        of_pencil = symmetric_eigenvalues(root * A * root, Eigen::MatrixXd(mass.asDiagonal()));
  for (int k = 0; k < n; ++k) {
    const double exact = 2 - 2 * std::cos((k + 1) * std::numbers::pi / (n + 1));
    EXPECT_NEAR(own[k], exact, 1e-13);
    EXPECT_NEAR(of_pencil[k], exact, 1e-13);
  }
}

TEST(Dense, LeastSquaresTakesTheShortestOfManySolutions) {
  Eigen::MatrixXd A(4, 3);
  A << 1, 0, 1, 0, 1, 1, 1, 1, 2, 2, -1, 1;  // the third column is the sum of the others
  const Eigen::Vector3d shortest(1, 2, 3);   // orthogonal to the null vector (1, 1, -1)
  const LeastSquares fit = least_squares(A, A * shortest);
  EXPECT_EQ(fit.rank, 2);
  EXPECT_LT((fit.X - shortest).norm(), 1e-13);
  EXPECT_EQ(least_squares(Eigen::MatrixXd(0, 3), Eigen::MatrixXd(0, 2)).rank, 0);
}

TEST(Dense, LeastSquaresLeavesAResidualOrthogonalToTheColumns) {
  Eigen::MatrixXd A(5, 2), B(5, 2);
  A << 1, 0, 1, 1, 1, 2, 1, 3, 1, 5;
  B << 1, 2, 0, 1, 4, 1, 2, 2, 3, 7;
  const LeastSquares fit = least_squares(A, B);
  EXPECT_EQ(fit.rank, 2);
  EXPECT_LT((A.transpose() * (A * fit.X - B)).norm(), 1e-12);
}

TEST(Dense, SymmetricSolveIsTheInverse) {
  const Eigen::MatrixXd A = second_differences(9), X = Eigen::MatrixXd::Identity(9, 2);
  EXPECT_LT((symmetric_solve(A, A * X) - X).norm(), 1e-13);
}

}  // namespace
}  // namespace springproof::dense_test
