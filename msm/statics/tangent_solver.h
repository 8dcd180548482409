// Linear solver for the tangent of a model: direct when small, else a Krylov method preconditioned by the rest state's
// multigrid.
#pragma once

#include <memory>
#include <string>

#include "msm/algebra/krylov.h"
#include "msm/multigrid/cut_multigrid.h"
#include "msm/multigrid/multigrid.h"
#include "msm/multigrid/network_multigrid.h"

namespace springproof {

/// The model with the symmetric form of momentum dispersion, which preconditions models with a non-conservative form.
MassSpringModel symmetric_companion(const MassSpringModel& model);

class TangentSolver {
 public:
  /// `direct_limit`: largest number of free unknowns for which the tangent is factored.
  TangentSolver(const MassSpringModel& model, const std::vector<char>& fixed, long direct_limit);

  /// Sets the tangent to that at x.
  /// @return false if it (not conservative: that of its symmetric companion) is found not to be positive definite.
  bool take(const NodalVectors& x);

  /// u = K^-1 b on the free unknowns, 0 on the fixed; converged also where the residual is round-off.
  KrylovResult solve(const Eigen::VectorXd& b, double tolerance, int max_iterations, Eigen::VectorXd& u) const;

  /// y = K x with the current tangent, all unknowns.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

  /// Positive definiteness of the current tangent (not conservative: of the companion's).
  bool stable() const;

  double largest_diagonal() const;
  long unknowns() const { return unknowns_; }
  std::string name() const;  ///< "Cholesky", "CG + multigrid", ...

 private:
  /// A stiffness operator: that of a list at rest if there is one, else the assembled matrix.
  struct Stiffness {
    const Tangent& assembled;
    const ListStiffness<double>* at_rest;
  };
  Stiffness stiffness() const { return {K_, at_rest_ ? list_.get() : nullptr}; }
  Stiffness symmetric_stiffness() const;
  void multiply(const Stiffness& K, const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  Eigen::VectorXd diagonal() const;  ///< of the model's own stiffness; not of a lattice at rest
  KrylovResult iterate(const Stiffness& K, bool symmetric, const Eigen::VectorXd& b, double tolerance,
                       int max_iterations, Eigen::VectorXd& u) const;
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;
  void clear_fixed(Eigen::VectorXd& v) const;

  const MassSpringModel& model_;
  std::vector<char> fixed_;
  long unknowns_ = 0;
  std::unique_ptr<MassSpringModel> companion_;  ///< of a model that is not conservative
  Tangent K_, companion_K_;
  bool direct_ = false;
  bool at_rest_ = false;  ///< lattice_ or list_ provides the tangent, K_ is not updated
  DirectSolver factors_;
  std::unique_ptr<Multigrid> lattice_;
  std::unique_ptr<CutMultigrid> cut_;
  std::unique_ptr<NetworkMultigrid> network_;
  std::unique_ptr<ListStiffness<double>> list_, companion_list_;  ///< of networks that it covers
};

}  // namespace springproof
