// Implicit dynamics: steps that may be larger than the explicit bound.
#pragma once

#include <memory>
#include <optional>

#include "msm/algebra/direct_solver.h"
#include "msm/algebra/krylov.h"
#include "msm/dynamics/motion.h"
#include "msm/dynamics/terms/energy_momentum.h"
#include "msm/dynamics/terms/plane_contact.h"
#include "msm/multigrid/multigrid.h"

namespace springproof {

/// Each step is solved by Newton's method, whose linear equations GMRES solves with differences of the forces (their
/// derivative is not symmetric).  Preconditioner: the factors of mass and tangent stiffness of an earlier state,
/// renewed when GMRES is slow; on lattices of full cells of more than `cholesky_limit` unknowns one multigrid cycle of
/// the rest state, turned with a body that is not held.
///
/// Nodes that end a step on a plane (PlaneConstraint) have lost their velocity along its normal then, as in explicit
/// steps.  The reactions at the end of the step do no work on nodes that stay, and take some from those that land, so
/// that the energy does not grow; momentum changes by what the plane gives.
///
/// Its branches are those at its positions; velocities of fixed unknowns are the mean over the last step.
class ImplicitMotion : public MotionOfNodes {
 public:
  /// @param model a model
  /// @param density [kg/m^3]
  /// @param options with a time step and an integrator that takes large ones, of which damping, viscosity, relaxation
  /// and
  ///   contact are read; nodes may end a step on the plane, without friction, which counts the impulses
  /// @throws std::invalid_argument if the model has no energy-momentum forces and these are asked for.
  ImplicitMotion(const MassSpringModel& model, double density, const MotionOptions& options);

  /// Those of the end of the next step; a step's loads are the mean of those of its two ends (energy-momentum) or those
  /// of its end.
  void set_conditions(const BoundaryConditions& conditions) override;
  NodalVectors relaxing_forces() const override;
  std::optional<BranchEnergies> branch_energies() const override;

  /// @return the norms of internal and external forces over the last step; NaN if it has none, with the reason
  ///   in failure().
  ForceNorms advance(long steps) override;

  std::string description() const override;
  std::string failure() const override { return failure_; }

 private:
  /// A step from x0 as m a (x1 - inertial) = force - damping m rate (x1 - x0), rate (x1 - x0) the mean velocity.
  struct Formula {
    double a, rate;
    double of_stiffness;  ///< df/dx1 relative to the tangent stiffness, dashpots included
    NodalVectors inertial;
  };
  struct Balance {
    NodalVectors force;  ///< internal and external [N]
    NodalVectors whole;  ///< with inertia and damping, which reactions balance [N]
    Eigen::VectorXd
        unbalanced;  ///< the same, zero on fixed unknowns and along the normal of a plane on nodes on it [N]
  };
  Formula formula() const;
  bool step(double dt, int halvings);
  bool solve_step();
  bool solve(const Formula& step, NodalVectors& x1, Balance& b);
  void land(const Formula& step, const NodalVectors& x1, const Balance& b, NodalVectors& v1);
  NodalVectors predicted() const;
  Balance balance(const Formula& step, const NodalVectors& x1);
  void iterate(const Formula& step, double enough, NodalVectors& x1, Balance& b);
  void newton_step(const Formula& step, double relative, NodalVectors& x1, Balance& b);
  NodalVectors with_supports(NodalVectors x) const;
  Eigen::VectorXd free_part(NodalVectors v) const;
  NodalVectors force(const Formula& step, NodalVectors x1) const;
  void prepare(const Formula& step);
  void renew(const Formula& step, const NodalVectors& x1);
  Eigen::VectorXd correction(const Eigen::VectorXd& r) const;
  bool factored() const { return !cycle_; }
  bool held() const;

  MotionOptions options_;
  double density_, safe_step_;
  Eigen::VectorXd mass_;
  double spacing_;  ///< of the nodes [m]
  std::unique_ptr<EnergyMomentum> secant_;
  NodalVectors external_before_;
  double dt_ = 0;  ///< of the present step [s]
  long advanced_ = 0, factorisations_ = 0;
  long halved_ = 0;       ///< steps that had no solution and were made in halves
  long evaluations_ = 0;  ///< of the forces
  std::optional<PlaneConstraint> plane_;
  std::string failure_;
  ForceNorms norms_;

  double prepared_for_ = 0;  ///< the mass term a that B was made for
  bool renewed_ = false;
  Tangent K_;
  double scale_ = 1;  ///< B = (factors of K + a / scale M)^-1 / scale
  std::unique_ptr<DirectSolver> factors_;
  std::unique_ptr<Multigrid> cycle_;
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();  ///< of the body since rest
};

}  // namespace springproof
