// Errors of PETSc as exceptions, and the factors of a symmetric matrix.
#pragma once

#include <petscmat.h>

#include <Eigen/Dense>

#include "problem/system/owned.h"

namespace springproof::fem {

/// @throws std::runtime_error with PETSc's own words, unless the code is 0.
void succeed(PetscErrorCode code);

using OwnedMat = Owned<Mat, MatDestroy>;
using OwnedVec = Owned<Vec, VecDestroy>;

/// L D L^T of a symmetric matrix, definite or not (MUMPS).
class SymmetricFactors {
 public:
  /// Only the upper triangle is read.
  explicit SymmetricFactors(Mat matrix);

  /// x = A^-1 b
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

  /// The number of negative eigenvalues (Sylvester).
  PetscInt negative_pivots() const;

 private:
  OwnedMat factors_;
};

}  // namespace springproof::fem
