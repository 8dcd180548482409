// Krylov solvers (conjugate gradients, GMRES) for matrix-free operators.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace springproof {

using Operator = std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& y)>;  ///< y = A x

struct KrylovResult {
  bool converged = false;
  int iterations = 0;
  double residual = 0;              ///< |b - A x| / |b|, recomputed at the end
  bool negative_curvature = false;  ///< CG met p . A p <= 0: A is not positive definite
};

/// Preconditioned conjugate gradients starting from x; A and the preconditioner are symmetric positive definite.
KrylovResult conjugate_gradients(const Operator& A, const Operator& precondition, const Eigen::VectorXd& b,
                                 double tolerance, int max_iterations, Eigen::VectorXd& x);

/// Flexible right-preconditioned restarted GMRES starting from x: the preconditioner may be inexact, in single
/// precision or itself an iteration; the preconditioned vectors are stored in single precision.
KrylovResult gmres(const Operator& A, const Operator& precondition, const Eigen::VectorXd& b, double tolerance,
                   int max_iterations, int restart, Eigen::VectorXd& x);

}  // namespace springproof
