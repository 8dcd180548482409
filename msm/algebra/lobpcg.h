// Smallest eigenpairs of K x = lambda M x for matrix-free operators.
#pragma once

#include "msm/algebra/krylov.h"

namespace springproof {

struct SmallestEigenpairs {
  Eigen::VectorXd values;   ///< ascending
  Eigen::MatrixXd vectors;  ///< M-orthonormal columns
  int iterations = 0;
  double residual = 0;  ///< largest |K x - lambda M x| / |lambda M x| of the wanted
  bool converged = false;
};

/// Locally optimal block preconditioned conjugate gradients (Knyazev 2001) with bases kept orthonormal in M (Hetmaniuk
/// and Lehoucq 2006).  K and M are symmetric and positive semidefinite.  The M-orthonormal columns of `deflated`, which
/// span the null space of K, are left out; `precondition` approximates the inverse of K beside them and may be an
/// iteration.  Starts from `start`, whose columns beyond the first `wanted` are guards: they need not converge, and of
/// multiple eigenvalues none is lost as long as there are as many.
SmallestEigenpairs smallest_eigenpairs(const Operator& K, const Operator& M, const Operator& precondition,
                                       const Eigen::MatrixXd& deflated, const Eigen::MatrixXd& start, int wanted,
                                       double tolerance, int max_iterations);

/// The same columns, orthonormal in M and to the M-orthonormal columns `to`; fewer if they are dependent.
Eigen::MatrixXd orthonormalised(const Operator& M, Eigen::MatrixXd columns, const Eigen::MatrixXd& to);

}  // namespace springproof
