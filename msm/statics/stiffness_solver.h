// Linear solvers for the tangent of a model: direct when small, else a Krylov method preconditioned by the rest state's
// multigrid.
#pragma once

#include <memory>
#include <string>

#include "msm/algebra/krylov.h"
#include "msm/laws/laws.h"

namespace springproof {

/// The model with the symmetric form of momentum dispersion, which preconditions models with a non-conservative form.
MassSpringModel symmetric_companion(const MassSpringModel& model);

/// The tangent K of a model at the state of the last take(), and what solves with it.  Vectors hold all unknowns.
class StiffnessSolver {
 public:
  explicit StiffnessSolver(std::vector<char> fixed);
  virtual ~StiffnessSolver() = default;

  /// Sets the tangent to that at x.
  /// @return false if it (not conservative: that of its symmetric companion) is found not to be positive definite.
  virtual bool take(const NodalVectors& x) = 0;
  virtual void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const = 0;      ///< y = K x
  virtual void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const = 0;  ///< z ~ K^-1 r, 0 on the fixed
  virtual Eigen::VectorXd diagonal() const = 0;
  virtual std::string name() const = 0;  ///< "Cholesky", "CG + multigrid", ...

  /// u = K^-1 b on the free unknowns, 0 on the fixed; converged also where the residual is round-off.
  virtual KrylovResult solve(const Eigen::VectorXd& b, double tolerance, int max_iterations, Eigen::VectorXd& u) const;

  /// Positive definiteness of the current tangent (not conservative: of the companion's).
  virtual bool stable() const;

  long unknowns() const { return unknowns_; }  ///< free ones

 protected:
  const std::vector<char>& fixed() const { return fixed_; }
  Operator on_free_unknowns() const;  ///< K, with zeros on the fixed
  Operator preconditioner() const;

 private:
  std::vector<char> fixed_;
  long unknowns_;
};

/// The solver for a model, which must outlive it.
/// @param fixed unknowns, carried ones included
/// @param direct_limit largest number of free unknowns for which the tangent is factored
std::unique_ptr<StiffnessSolver> solver_for(const MassSpringModel& model, const std::vector<char>& fixed,
                                            long direct_limit);

}  // namespace springproof
