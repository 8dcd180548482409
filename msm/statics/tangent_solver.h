// Solves with the tangent of a model: directly when small, else by a Krylov method over the rest state's multigrid.
#pragma once

#include <memory>
#include <string>

#include "msm/algebra/krylov.h"
#include "msm/multigrid/multigrid.h"
#include "msm/multigrid/network_multigrid.h"

namespace springproof {

/// The model with the energy form of momentum dispersion in place of one without: what preconditions the latter.
MassSpringModel symmetric_companion(const MassSpringModel& model);

class TangentSolver {
 public:
  /// `direct_limit`: up to so many free unknowns the tangent is factored.
  TangentSolver(const MassSpringModel& model, const std::vector<char>& fixed, long direct_limit);

  /// Takes over the tangent at x.  @return false if it is seen not to be positive definite (not conservative: its
  /// symmetric companion).
  bool take(const NodalVectors& x);

  /// u = K^-1 b on the free unknowns, 0 on the fixed; converged also where the residual is round-off.
  KrylovResult solve(const Eigen::VectorXd& b, double tolerance, int max_iterations, Eigen::VectorXd& u) const;

  /// y = K x with the tangent taken over last, all unknowns.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

  /// Positive definiteness of the tangent (of the companion's) taken over last.
  bool stable() const;

  double largest_diagonal() const;
  long unknowns() const { return unknowns_; }
  std::string name() const;  ///< "Cholesky", "CG + multigrid", ...

 private:
  /// A stiffness: that of a list at rest if there is one, else what was assembled.
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
  bool at_rest_ = false;  ///< of lattice_ or list_: K_ is left empty
  DirectSolver factors_;
  std::unique_ptr<Multigrid> lattice_;
  std::unique_ptr<NetworkMultigrid> network_;
  std::unique_ptr<ListStiffness<double>> list_, companion_list_;  ///< of networks that it covers
};

}  // namespace springproof
