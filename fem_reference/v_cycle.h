// Multigrid preconditioner.  Part of elastic_solver.cpp, as stiffness.h.
#pragma once

#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/multigrid/mg_constrained_dofs.h>
#include <deal.II/multigrid/mg_transfer_matrix_free.h>

#include <memory>

#include "fem_reference/elastic_system.h"
#include "fem_reference/stiffness.h"

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

// A symmetric V-cycle in single precision, Chebyshev smoothing.
template <int degree>
class VCycle {
 public:
  using Level = Stiffness<degree, float>;
  using Smoother = dealii::PreconditionChebyshev<Level, Vector<float>>;

  VCycle(const ElasticSystem& system, const Coefficients<float>& coefficients)
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
      levels_.push_back(std::make_unique<Level>(*system.body.mapping, dof_handler_, l, std::move(constrained), coefficients));
      smoothers_.push_back(std::make_unique<Smoother>());
      smoothers_.back()->initialize(*levels_.back(), smoother_data(l));
      x_[l] = b_[l] = t_[l] = levels_.back()->vector();
    }
  }

  void vmult(Vector<double>& y, const Vector<double>& x) const {
    transfer_.copy_to_mg(dof_handler_, b_, x);
    cycle(levels_.size() - 1);
    transfer_.copy_from_mg(dof_handler_, y, x_);
  }

  // Takes the body as deformed by u.
  void deform(const Vector<double>& u) {
    transfer_.interpolate_to_mg(dof_handler_, t_, u);
    for (unsigned int l = 0; l < levels_.size(); ++l) {
      levels_[l]->deform(t_[l]);
      smoothers_[l]->initialize(*levels_[l], smoother_data(l));
    }
  }

 private:
  typename Smoother::AdditionalData smoother_data(unsigned int level) const {
    typename Smoother::AdditionalData data;
    const bool solves = level == 0 && !below_ && levels_[0]->m() < largest_coarse_system;
    data.degree = solves ? dealii::numbers::invalid_unsigned_int : 5;
    data.smoothing_range = solves ? 1e-2 : 15;
    data.eig_cg_n_iterations = solves ? levels_[0]->m() : 12;
    data.preconditioner =
        std::make_shared<dealii::DiagonalMatrix<Vector<float>>>(levels_[level]->inverse_diagonal());
    return data;
  }

  // x_[l] from b_[l]
  void cycle(unsigned int l) const {
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
  mutable dealii::MGLevelObject<Vector<float>> x_, b_, t_;
  mutable Vector<float> correction_;
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
