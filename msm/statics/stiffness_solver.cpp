#include "msm/statics/stiffness_solver.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "msm/algebra/direct_solver.h"
#include "msm/algebra/fixed.h"
#include "msm/algebra/noise.h"
#include "msm/kernels/list_stiffness.h"
#include "msm/laws/capabilities.h"
#include "msm/multigrid/cut/cut_multigrid.h"
#include "msm/multigrid/multigrid.h"
#include "msm/multigrid/network_multigrid.h"

namespace springproof {
namespace {

constexpr double worst_residual = 1e-6;   // attributed to round-off; for mechanisms the estimate is unbounded
constexpr double inner_tolerance = 1e-6;  // of the symmetric solves that precondition GMRES
constexpr int most_inner_iterations = 4000;

// Measured cells have no mixed form: where their volume is this many times as stiff as their shape (nu = 0.49) they are
// factored up to this many unknowns.
constexpr double stiff_volume = 50;
constexpr long stiff_volume_limit = 40000;

bool has_stiff_volume(const MassSpringModel& model) {
  const auto* measured = law_of<MeasuredCells>(model);
  if (!measured) return false;
  const AveragedSprings mean = mean_springs(*measured, model.network.cells);
  return mean.lame_lambda > stiff_volume * mean.shear_modulus;
}

void assemble(const MassSpringModel& model, const NodalVectors& x, Tangent& K) {
  if (K.local.nodes() == 0) K.local = BlockMatrix(model.network);
  update_tangent(model, x, K);
}

class CholeskySolver : public StiffnessSolver {
 public:
  CholeskySolver(const MassSpringModel& model, const std::vector<char>& fixed)
      : StiffnessSolver(fixed), model_(model) {}

  bool take(const NodalVectors& x) override {
    assemble(model_, x, K_);
    return factors_.factor(K_, fixed());
  }
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const override { K_.multiply(x, y); }
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const override { factors_.solve(r, z); }
  Eigen::VectorXd diagonal() const override { return K_.diagonal(); }
  std::string name() const override { return "Cholesky"; }
  bool stable() const override { return factors_.negative_pivots() == 0; }

 private:
  const MassSpringModel& model_;
  Tangent K_;
  DirectSolver factors_;
};

/// Conjugate gradients over a cycle for the stiffness at rest, which the cycle has too (multiply, diagonal, apply).
template <class Cycle>
class MultigridSolver : public StiffnessSolver {
 public:
  template <class... Arguments>
  MultigridSolver(const MassSpringModel& model, const std::vector<char>& fixed, std::string name,
                  Arguments&&... of_cycle)
      : StiffnessSolver(fixed), model_(model), name_(std::move(name)), cycle_(std::forward<Arguments>(of_cycle)...) {}

  bool take(const NodalVectors& x) override {
    at_rest_ = x == model_.network.X;
    if (!at_rest_) assemble(model_, x, K_);
    return true;
  }
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const override {
    at_rest_ ? cycle_.multiply(x, y) : K_.multiply(x, y);
  }
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const override { cycle_.apply(r, z); }
  Eigen::VectorXd diagonal() const override { return at_rest_ ? cycle_.diagonal() : K_.diagonal(); }
  std::string name() const override { return name_; }

 protected:
  const MassSpringModel& model_;
  std::string name_;
  mutable Cycle cycle_;
  Tangent K_;  ///< away from rest
  bool at_rest_ = false;
};

/// At rest in the lattice's own arrays, without a conversion in each iteration.
class LatticeSolver : public MultigridSolver<Multigrid> {
 public:
  using MultigridSolver::MultigridSolver;

  KrylovResult solve(const Eigen::VectorXd& b, double tolerance, int max_iterations,
                     Eigen::VectorXd& u) const override {
    return at_rest_ ? cycle_.solve(b, tolerance, max_iterations, u)
                    : StiffnessSolver::solve(b, tolerance, max_iterations, u);
  }
};

/// GMRES for models that are not conservative, preconditioned by solutions with the symmetric companion.
class UnsymmetricSolver : public StiffnessSolver {
 public:
  UnsymmetricSolver(const MassSpringModel& model, const std::vector<char>& fixed, long direct_limit)
      : StiffnessSolver(fixed),
        model_(model),
        companion_(symmetric_companion(model)),
        symmetric_(solver_for(companion_, fixed, direct_limit)) {
    if (unknowns() > direct_limit && can(model, Capability::list_stiffness))
      rest_.emplace(model, std::make_shared<SpringBlocks>(model.network));
  }

  bool take(const NodalVectors& x) override {
    at_rest_ = rest_ && x == model_.network.X;
    if (!at_rest_) assemble(model_, x, K_);
    return symmetric_->take(x);
  }
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const override {
    at_rest_ ? rest_->multiply(x, y) : K_.multiply(x, y);
  }
  /// A cycle alone would leave the soft modes of a body held at few points to GMRES, which loses them at a restart.
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const override {
    symmetric_->solve(r, inner_tolerance, most_inner_iterations, z);
  }
  Eigen::VectorXd diagonal() const override { return at_rest_ ? rest_->diagonal() : K_.diagonal(); }
  std::string name() const override { return "GMRES + " + symmetric_->name() + " of the symmetric form"; }
  bool stable() const override { return symmetric_->stable(); }

  KrylovResult solve(const Eigen::VectorXd& b, double tolerance, int max_iterations,
                     Eigen::VectorXd& u) const override {
    Eigen::VectorXd free = b;
    clear_fixed(fixed(), free);
    u.setZero(b.size());
    return gmres(on_free_unknowns(), preconditioner(), free, tolerance, max_iterations, 60, u);
  }

 private:
  const MassSpringModel& model_;
  const MassSpringModel companion_;
  const std::unique_ptr<StiffnessSolver> symmetric_;  ///< of the companion
  std::optional<ListStiffness<double>> rest_;         ///< of networks that have it
  Tangent K_;                                         ///< where that is not used
  bool at_rest_ = false;
};

}  // namespace

MassSpringModel symmetric_companion(const MassSpringModel& model) {
  MassSpringModel companion = model;
  if (auto* dispersion = law_of<MomentumDispersion>(companion))
    *dispersion = {dispersion->q, Dispersion::symmetric, {}, {}};
  return companion;
}

StiffnessSolver::StiffnessSolver(std::vector<char> fixed)
    : fixed_(std::move(fixed)), unknowns_(std::count(fixed_.begin(), fixed_.end(), 0)) {}

Operator StiffnessSolver::on_free_unknowns() const {
  return [this](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
    multiply(x, y);
    clear_fixed(fixed_, y);
  };
}

Operator StiffnessSolver::preconditioner() const {
  return [this](const Eigen::VectorXd& r, Eigen::VectorXd& z) { precondition(r, z); };
}

KrylovResult StiffnessSolver::solve(const Eigen::VectorXd& b, double tolerance, int max_iterations,
                                    Eigen::VectorXd& u) const {
  Eigen::VectorXd free = b;
  clear_fixed(fixed_, free);
  u.setZero(b.size());
  KrylovResult result = conjugate_gradients(on_free_unknowns(), preconditioner(), free, tolerance, max_iterations, u);
  if (result.converged || result.negative_curvature) return result;
  // Near nu = 1/2 forces cancel in the product, and no solution in double precision leaves a smaller residual.
  const double round_off =
      64 * std::numeric_limits<double>::epsilon() * diagonal().cwiseProduct(u).norm() / free.norm();
  result.converged = result.residual <= std::min(round_off, worst_residual);
  return result;
}

bool StiffnessSolver::stable() const {
  // Conjugate gradients on an arbitrary right-hand side meet a direction of negative curvature if there is one
  // (Lanczos).
  Eigen::VectorXd b(static_cast<Eigen::Index>(fixed_.size())), u;
  fill_with_noise(b);
  return !solve(b, 1e-6, 4000, u).negative_curvature;
}

std::unique_ptr<StiffnessSolver> solver_for(const MassSpringModel& model, const std::vector<char>& fixed,
                                            long direct_limit) {
  if (!can(model, Capability::energy)) return std::make_unique<UnsymmetricSolver>(model, fixed, direct_limit);
  if (has_stiff_volume(model)) direct_limit = std::max(direct_limit, stiff_volume_limit);
  if (std::count(fixed.begin(), fixed.end(), 0) <= direct_limit) return std::make_unique<CholeskySolver>(model, fixed);
  if (can(model, Capability::equal_cells))
    return std::make_unique<LatticeSolver>(model, fixed, "CG + multigrid", lattice_levels(model.network, fixed),
                                           cell_stiffness(model).total);
  if (can(model, Capability::cut_multigrid))
    return std::make_unique<MultigridSolver<CutMultigrid>>(model, fixed, "CG + multigrid", model, fixed);
  return std::make_unique<MultigridSolver<NetworkMultigrid>>(model, fixed, "CG + network multigrid", model, fixed);
}

}  // namespace springproof
