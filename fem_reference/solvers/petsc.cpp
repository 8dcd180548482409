#include "fem_reference/solvers/petsc.h"

#include <fmt/format.h>

#include <stdexcept>

namespace springproof::fem {
namespace {

/// A vector of PETSc's that views the entries of Eigen's.
struct View {
  explicit View(const Eigen::VectorXd& x) {
    succeed(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, PetscInt(x.size()), x.data(), &vector));
  }
  View(const View&) = delete;
  View& operator=(const View&) = delete;
  ~View() { VecDestroy(&vector); }
  Vec vector = nullptr;
};

}  // namespace

void succeed(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw std::runtime_error(fmt::format("PETSc: {}", text ? text : "unknown error"));
}

SymmetricFactors::SymmetricFactors(Mat matrix) {
  MatFactorInfo info;
  IS rows = nullptr, columns = nullptr;
  succeed(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
  succeed(MatGetFactor(matrix, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &factors_));
  succeed(MatFactorInfoInitialize(&info));
  succeed(MatGetOrdering(matrix, MATORDERINGEXTERNAL, &rows, &columns));
  succeed(MatCholeskyFactorSymbolic(factors_, matrix, rows, &info));
  succeed(MatCholeskyFactorNumeric(factors_, matrix, &info));
  succeed(ISDestroy(&rows));
  succeed(ISDestroy(&columns));
}

SymmetricFactors::~SymmetricFactors() { MatDestroy(&factors_); }

Eigen::VectorXd SymmetricFactors::solve(const Eigen::VectorXd& b) const {
  Eigen::VectorXd x(b.size());
  const View from(b), to(x);
  succeed(MatSolve(factors_, from.vector, to.vector));
  return x;
}

PetscInt SymmetricFactors::negative_pivots() const {
  PetscInt negative = 0;
  succeed(MatGetInertia(factors_, &negative, nullptr, nullptr));
  return negative;
}

}  // namespace springproof::fem
