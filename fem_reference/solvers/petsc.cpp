#include "fem_reference/solvers/petsc.h"

#include <fmt/format.h>

#include <stdexcept>

namespace springproof::fem {
namespace {

/// A vector of PETSc's that views the entries of Eigen's.
OwnedVec view(const Eigen::VectorXd& x) {
  OwnedVec vector;
  succeed(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, PetscInt(x.size()), x.data(), &vector));
  return vector;
}

}  // namespace

void succeed(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw std::runtime_error(fmt::format("PETSc: {}", text ? text : "unknown error"));
}

SymmetricFactors::SymmetricFactors(Mat matrix) {
  MatFactorInfo info;
  Owned<IS, ISDestroy> rows, columns;
  succeed(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
  succeed(MatGetFactor(matrix, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &factors_));
  succeed(MatFactorInfoInitialize(&info));
  succeed(MatGetOrdering(matrix, MATORDERINGEXTERNAL, &rows, &columns));
  succeed(MatCholeskyFactorSymbolic(factors_, matrix, rows, &info));
  succeed(MatCholeskyFactorNumeric(factors_, matrix, &info));
}

Eigen::VectorXd SymmetricFactors::solve(const Eigen::VectorXd& b) const {
  Eigen::VectorXd x(b.size());
  succeed(MatSolve(factors_, view(b), view(x)));
  return x;
}

PetscInt SymmetricFactors::negative_pivots() const {
  PetscInt negative = 0;
  succeed(MatGetInertia(factors_, &negative, nullptr, nullptr));
  return negative;
}

}  // namespace springproof::fem
