#include "msm/algebra/direct_solver.h"

namespace springproof {

void DirectSolver::number_free(const std::vector<char>& fixed) {
  if (analysed_) return;
  free_.clear();
  number_.assign(fixed.size(), -1);
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (!fixed[i]) {
      number_[i] = static_cast<int>(free_.size());
      free_.push_back(static_cast<int>(i));
    }
}

bool DirectSolver::factor_lower(const Eigen::SparseMatrix<double>& L, double round_off) {
  if (!analysed_) ldlt_.analyzePattern(L);
  analysed_ = true;
  ldlt_.factorize(L);
  if (ldlt_.info() != Eigen::Success) {
    negative_ = -1;
    return false;
  }
  negative_ = static_cast<int>((ldlt_.vectorD().array() <= round_off * ldlt_.vectorD().maxCoeff()).count());
  return negative_ == 0;
}

void DirectSolver::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  Eigen::VectorXd reduced(unknowns());
  for (int i = 0; i < unknowns(); ++i) reduced[i] = b[free_[i]];
  const Eigen::VectorXd solution = ldlt_.solve(reduced);
  x.setZero(b.size());
  for (int i = 0; i < unknowns(); ++i) x[free_[i]] = solution[i];
}

}  // namespace springproof
