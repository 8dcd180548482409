#include "msm/statics/tangent_solver.h"

#include <algorithm>
#include <limits>

#include "msm/algebra/noise.h"

namespace springproof {
namespace {

constexpr double worst_residual = 1e-6;   // attributed to round-off; for mechanisms the estimate is unbounded
constexpr double inner_tolerance = 1e-6;  // of the symmetric solves that precondition GMRES

}  // namespace

MassSpringModel symmetric_companion(const MassSpringModel& model) {
  MassSpringModel companion = model;
  for (ForceLaw& law : companion.laws)
    if (auto* dispersion = std::get_if<MomentumDispersion>(&law))
      *dispersion = {dispersion->q, Dispersion::symmetric, {}, {}};
  return companion;
}

TangentSolver::TangentSolver(const MassSpringModel& model, const std::vector<char>& fixed, long direct_limit)
    : model_(model),
      fixed_(fixed),
      unknowns_(std::count(fixed.begin(), fixed.end(), 0)),
      direct_(unknowns_ <= direct_limit) {
  if (!conservative(model)) companion_ = std::make_unique<MassSpringModel>(symmetric_companion(model));
  if (direct_) return;
  const Network& network = model.network;
  if (consists_of_cells(model))
    lattice_ = std::make_unique<Multigrid>(lattice_levels(network, fixed), cell_stiffness(model).total);
  else if (CutMultigrid::covers(model))
    cut_ = std::make_unique<CutMultigrid>(model, fixed);
  else {
    if (ListStiffness<double>::covers(model)) {
      list_ = std::make_unique<ListStiffness<double>>(model, std::make_shared<SpringBlocks>(network));
      if (companion_) companion_list_ = std::make_unique<ListStiffness<double>>(*companion_, list_->blocks());
    }
    network_ = std::make_unique<NetworkMultigrid>(companion_ ? *companion_ : model, fixed,
                                                  companion_ ? companion_list_.get() : list_.get());
  }
}

bool TangentSolver::take(const NodalVectors& x) {
  at_rest_ = (lattice_ || cut_ || list_) && x == model_.network.X;  // the multigrid or the list provides the tangent
  if (at_rest_) return true;
  if (K_.local.nodes() == 0) K_.local = BlockMatrix(model_.network);
  update_tangent(model_, x, K_);
  if (!companion_) return !direct_ || factors_.factor(K_, fixed_);
  if (companion_K_.local.nodes() == 0) companion_K_.local = BlockMatrix(model_.network);
  update_tangent(*companion_, x, companion_K_);
  return !direct_ || factors_.factor(companion_K_, fixed_);
}

void TangentSolver::precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  if (direct_)
    factors_.solve(r, z);
  else
    lattice_ ? lattice_->apply(r, z) : cut_ ? cut_->apply(r, z) : network_->apply(r, z);
}

void TangentSolver::clear_fixed(Eigen::VectorXd& v) const {
  for (std::size_t i = 0; i < fixed_.size(); ++i)
    if (fixed_[i]) v[i] = 0;
}

TangentSolver::Stiffness TangentSolver::symmetric_stiffness() const {
  if (!companion_) return stiffness();
  return {companion_K_, at_rest_ ? companion_list_.get() : nullptr};
}

void TangentSolver::multiply(const Stiffness& K, const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  if (K.at_rest)
    K.at_rest->multiply(x, y);
  else if (at_rest_ && lattice_)
    lattice_->multiply(x, y);
  else if (at_rest_)
    cut_->multiply(x, y);
  else
    K.assembled.multiply(x, y);
}

Eigen::VectorXd TangentSolver::diagonal() const {
  if (!at_rest_) return K_.diagonal();
  if (cut_) return cut_->diagonal();
  const std::vector<Eigen::Matrix3d> blocks = list_->node_blocks();
  Eigen::VectorXd d(static_cast<Eigen::Index>(fixed_.size()));
  for (std::size_t p = 0; p < blocks.size(); ++p) d.segment<3>(3 * list_->blocks()->order[p]) = blocks[p].diagonal();
  return d;
}

KrylovResult TangentSolver::iterate(const Stiffness& K, bool symmetric, const Eigen::VectorXd& b, double tolerance,
                                    int max_iterations, Eigen::VectorXd& u) const {
  const Operator apply = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
    multiply(K, x, y);
    clear_fixed(y);
  };
  const Operator condition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) { precondition(r, z); };
  Eigen::VectorXd free = b;
  clear_fixed(free);
  if (at_rest_ && lattice_) return lattice_->solve(free, tolerance, max_iterations, u);
  u.setZero(b.size());
  if (symmetric) {
    KrylovResult result = conjugate_gradients(apply, condition, free, tolerance, max_iterations, u);
    if (result.converged || result.negative_curvature) return result;
    // Near nu = 1/2 forces cancel in the product, and no solution in double precision leaves a smaller residual.
    const double round_off =
        64 * std::numeric_limits<double>::epsilon() * diagonal().cwiseProduct(u).norm() / free.norm();
    result.converged = result.residual <= std::min(round_off, worst_residual);
    return result;
  }
  // A cycle alone would leave the soft modes of a body held at few points to GMRES, which loses them at a restart.
  const Operator solved = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    direct_ ? precondition(r, z) : void(iterate(symmetric_stiffness(), true, r, inner_tolerance, max_iterations, z));
  };
  return gmres(apply, solved, free, tolerance, max_iterations, 60, u);
}

KrylovResult TangentSolver::solve(const Eigen::VectorXd& b, double tolerance, int max_iterations,
                                  Eigen::VectorXd& u) const {
  return iterate(stiffness(), !companion_, b, tolerance, max_iterations, u);
}

void TangentSolver::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const { multiply(stiffness(), x, y); }

bool TangentSolver::stable() const {
  if (direct_) return factors_.negative_pivots() == 0;
  // Conjugate gradients on an arbitrary right-hand side meet a direction of negative curvature if there is one
  // (Lanczos).
  Eigen::VectorXd b(static_cast<Eigen::Index>(fixed_.size())), u;
  fill_with_noise(b);
  return !iterate(symmetric_stiffness(), true, b, 1e-6, 4000, u).negative_curvature;
}

double TangentSolver::largest_diagonal() const {
  return at_rest_ && lattice_ ? lattice_->largest_diagonal() : diagonal().maxCoeff();
}

std::string TangentSolver::name() const {
  const std::string inner = direct_ ? "Cholesky" : lattice_ || cut_ ? "multigrid" : "network multigrid";
  if (companion_) return "GMRES + " + inner + " of the symmetric form";
  return direct_ ? inner : "CG + " + inner;
}

}  // namespace springproof
