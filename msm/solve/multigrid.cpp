#include "msm/solve/multigrid.h"

#include <Eigen/Eigenvalues>
#include <stdexcept>

namespace springproof {

BlockMatrix assemble(const LatticeLevel& level, const CellMatrix& cell) {
  BlockMatrix K(coupled_nodes(level.nodes, level.cells));
  for (std::size_t c = 0; c < level.cells.size(); ++c) {
    const double scale = level.edge_ratio * level.fill[c];
    for (int m = 0; m < 8; ++m)
      for (int n = 0; n < 8; ++n)
        K.add(level.cells[c][m], level.cells[c][n], scale * cell.block<3, 3>(3 * m, 3 * n));
  }
  return K;
}

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

bool DirectSolver::factor_lower(const Eigen::SparseMatrix<double>& L) {
  if (!analysed_) ldlt_.analyzePattern(L);
  analysed_ = true;
  ldlt_.factorize(L);
  if (ldlt_.info() != Eigen::Success) {
    negative_ = -1;
    return false;
  }
  // A pivot of round-off is a mechanism: what it would give is no equilibrium.
  const double round_off = 1e-14 * ldlt_.vectorD().maxCoeff();
  negative_ = static_cast<int>((ldlt_.vectorD().array() <= round_off).count());
  return negative_ == 0;
}

void DirectSolver::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  Eigen::VectorXd reduced(unknowns());
  for (int i = 0; i < unknowns(); ++i) reduced[i] = b[free_[i]];
  const Eigen::VectorXd solution = ldlt_.solve(reduced);
  x.setZero(b.size());
  for (int i = 0; i < unknowns(); ++i) x[free_[i]] = solution[i];
}

Multigrid::Multigrid(std::vector<LatticeLevel> levels, const CellMatrix& cell, int smoothing_degree, bool may_float)
    : levels_(std::move(levels)), degree_(smoothing_degree) {
  const Eigen::VectorXd root = cell.diagonal().cwiseSqrt().cwiseInverse();
  const CellMatrix scaled = root.asDiagonal() * cell * root.asDiagonal();
  largest_eigenvalue_ = Eigen::SelfAdjointEigenSolver<CellMatrix>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[23];
  for (const LatticeLevel& level : levels_) {
    matrix_.push_back(assemble(level, cell));
    inverse_diagonal_.push_back(matrix_.back().diagonal().cwiseInverse());
    for (std::size_t i = 0; i < level.fixed.size(); ++i)
      if (level.fixed[i]) inverse_diagonal_.back()[i] = 0;
  }
  if (coarsest_.factor(matrix_.back(), levels_.back().fixed)) return;
  if (!may_float)
    throw std::runtime_error("the coarsest lattice is singular: the body is not held, or the model has zero-energy modes");
  const double anchor = 1e-3 * matrix_.back().diagonal().mean();
  for (int n = 0; n < matrix_.back().nodes(); ++n) matrix_.back().add(n, n, anchor * Eigen::Matrix3d::Identity());
  if (!coarsest_.factor(matrix_.back(), levels_.back().fixed)) throw std::runtime_error("the coarsest lattice is not positive definite");
}

void Multigrid::smooth(std::size_t level, Eigen::VectorXd& r, Eigen::VectorXd& x, bool update_residual) const {
  Eigen::VectorXd z = Eigen::VectorXd::Zero(r.size()), Az;
  for (int k = 1; k <= degree_; ++k) {
    z = (2.0 * k - 3) / (2.0 * k + 1) * z +
        (8.0 * k - 4) / ((2.0 * k + 1) * largest_eigenvalue_) * inverse_diagonal_[level].cwiseProduct(r);
    x += z;
    if (k < degree_ || update_residual) {
      matrix_[level].multiply(z, Az);
      r -= Az;
    }
  }
}

void Multigrid::cycle(std::size_t level, const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  if (level + 1 == levels_.size()) {
    coarsest_.solve(b, x);
    return;
  }
  x.setZero(b.size());
  Eigen::VectorXd r = b, coarse_r, coarse_x, correction, Ac;
  smooth(level, r, x, true);
  levels_[level + 1].restrict_to(r, levels_[level].fixed, coarse_r);
  cycle(level + 1, coarse_r, coarse_x);
  levels_[level + 1].prolongate(coarse_x, levels_[level].fixed, correction);
  x += correction;
  matrix_[level].multiply(correction, Ac);
  r -= Ac;
  smooth(level, r, x, false);
}

}  // namespace springproof
