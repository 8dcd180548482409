// Matrix-free geometric multigrid preconditioner.  Part of elastic_solver.cpp, like stiffness.h.
#pragma once

#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/multigrid/mg_constrained_dofs.h>
#include <deal.II/multigrid/mg_transfer_matrix_free.h>

#include <Eigen/SparseCholesky>
#include <memory>
#include <optional>

#include "fem_reference/grid/processes.h"
#include "fem_reference/solvers/stiffness.h"
#include "fem_reference/system/elastic_system.h"

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

// Sparse Cholesky factors of the matrix of the coarsest level; none where they would cost more than iterating on it
// (`most_operations`), or where the matrix is distributed over processes or numerically not positive definite.
class CoarsestInverse : Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> {
 public:
  template <typename Level>
  explicit CoarsestInverse(const Level& level) {
    if (level.m() > most_rows || process_count() > 1) return;
    Eigen::SparseMatrix<double> K(level.m(), level.m());
    const auto entries = level.entries();
    K.setFromTriplets(entries.begin(), entries.end());
    analyzePattern(K);
    if (m_nonZerosPerCol.cast<double>().squaredNorm() > most_operations) return;
    factorize(K);
    there_ = info() == Eigen::Success;
  }
  explicit operator bool() const { return there_; }

  template <typename V>
  void vmult(V& y, const V& x) const {
    Eigen::VectorXd values(rows());
    for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = x.local_element(i);
    values = solve(values).eval();
    for (Eigen::Index i = 0; i < values.size(); ++i) y.local_element(i) = float(values[i]);
  }

 private:
  static constexpr unsigned int most_rows = 30000;
  static constexpr double most_operations = 5e8;  // half a second

  bool there_ = false;
};

// A symmetric V-cycle in single precision with Chebyshev smoothing (Adams et al. 2003).
template <int degree>
class VCycle {
 public:
  using Level = Stiffness<degree, float>;
  using Smoother = dealii::PreconditionChebyshev<Level, Vector<float>>;

  VCycle(const ElasticSystem& system, const ElasticCoefficients<float>& coefficients)
      : dof_handler_(system.dof_handler), below_(system.below) {
    const unsigned int n_levels = dof_handler_.get_triangulation().n_global_levels();
    constrained_dofs_.initialize(dof_handler_);
    for (unsigned int l = 0; l < n_levels; ++l)
      constrained_dofs_.add_boundary_indices(dof_handler_, l, system.level_constrained[l]);
    transfer_.initialize_constraints(constrained_dofs_);
    transfer_.build(dof_handler_);
    x_.resize(0, n_levels - 1);
    b_.resize(0, n_levels - 1);
    t_.resize(0, n_levels - 1);
    for (unsigned int l = 0; l < n_levels; ++l) {
      std::vector<unsigned int> constrained;
      for (const auto i : system.level_constrained[l]) constrained.push_back(i);
      levels_.push_back(
          std::make_unique<Level>(*system.body.mapping, dof_handler_, l, std::move(constrained), coefficients));
      smoothers_.push_back(std::make_unique<Smoother>());
      prepare(l);
      x_[l] = b_[l] = t_[l] = levels_.back()->vector();
    }
  }

  void vmult(Vector<double>& y, const Vector<double>& x) const {
    transfer_.copy_to_mg(dof_handler_, b_, x);
    cycle(levels_.size() - 1);
    transfer_.copy_from_mg(dof_handler_, y, x_);
  }

  // Sets up all levels for the body deformed by u.
  void deform(const Vector<double>& u) {
    transfer_.interpolate_to_mg(dof_handler_, t_, u);
    for (unsigned int l = 0; l < levels_.size(); ++l) {
      levels_[l]->deform(t_[l]);
      prepare(l);
    }
  }

 private:
  void prepare(unsigned int level) {
    if (level == 0) coarsest_.emplace(*levels_[0]);
    if (level > 0 || !*coarsest_) smoothers_[level]->initialize(*levels_[level], smoother_data(level));
  }

  typename Smoother::AdditionalData smoother_data(unsigned int level) const {
    typename Smoother::AdditionalData data;
    const bool solves = level == 0 && !below_ && levels_[0]->m() < largest_coarse_system;
    data.degree = solves ? dealii::numbers::invalid_unsigned_int : 5;
    data.smoothing_range = solves ? 1e-2 : 15;
    data.eig_cg_n_iterations = solves ? levels_[0]->m() : 12;
    data.preconditioner = std::make_shared<dealii::DiagonalMatrix<Vector<float>>>(levels_[level]->inverse_diagonal());
    return data;
  }

  // V-cycle from level l down: x_[l] from b_[l].
  void cycle(unsigned int l) const {
    if (l == 0 && *coarsest_) return coarsest_->vmult(x_[0], b_[0]);
    smoothers_[l]->vmult(x_[l], b_[l]);
    if (l == 0 && !below_) return;
    levels_[l]->vmult(t_[l], x_[l]);
    t_[l].sadd(-1, 1, b_[l]);
    if (l == 0) {
      correction_ = t_[0];
      below_(t_[0], correction_);
    } else {
      b_[l - 1] = 0;
      transfer_.restrict_and_add(l, b_[l - 1], t_[l]);
      cycle(l - 1);
      transfer_.prolongate(l, t_[l], x_[l - 1]);
    }
    x_[l] += t_[l];
    smoothers_[l]->step(x_[l], b_[l]);
  }

  static constexpr unsigned int largest_coarse_system = 30000;

  const dealii::DoFHandler<3>& dof_handler_;
  std::function<void(LevelVector&, const LevelVector&)> below_;
  dealii::MGConstrainedDoFs constrained_dofs_;
  dealii::MGTransferMatrixFree<3, float> transfer_;
  std::vector<std::unique_ptr<Level>> levels_;
  std::vector<std::unique_ptr<Smoother>> smoothers_;
  std::optional<CoarsestInverse> coarsest_;
  mutable dealii::MGLevelObject<Vector<float>> x_, b_, t_;
  mutable Vector<float> correction_;
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
