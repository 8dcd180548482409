// Newton's method with the pressure of each cell as an unknown: large displacements near nu = 1/2.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "msm/embedding/boundary.h"
#include "msm/laws/laws.h"

namespace springproof {

/// Finds x and p of   f_springs(x) + sum_c p_c dV_c/dx = external,   psi'(V_c/V) = p_c / kappa,  psi the volume term of
/// the model (msm/laws/volume_correction.h, strain_energy.h) and V the volume of the filled part of a cell.  A guess
/// with a wrong volume then causes no forces of kappa times the error, which impede the form without p.  Steps are
/// solved by GMRES preconditioned by the mixed multigrid of the rest state.
class MixedNewton {
 public:
  /// Whether the model is a lattice of springs with a volume term for which this form is worthwhile.
  static bool suits(const MassSpringModel& model);

  MixedNewton(const MassSpringModel& model, const std::vector<char>& fixed);

  /// Moves x, from the pressures of the step accepted last, to equilibrium under the conditions.
  /// @return false if it is not reached in max_iterations.
  bool step(const BoundaryConditions& conditions, double tolerance, int max_iterations, NodalVectors& x);
  void accept() { accepted_p_ = p_; }             ///< accepts the last step
  int iterations() const { return iterations_; }  ///< so far

 private:
  struct Linearised;
  Linearised linearise(const NodalVectors& x, const Eigen::VectorXd& external);  ///< also assembles K_
  void solve(const Linearised& at, const Eigen::VectorXd& r, const Eigen::VectorXd& g, double tolerance,
             Eigen::VectorXd& du, Eigen::VectorXd& dp);

  const Network& network_;
  std::vector<ForceLaw> springs_;  ///< the laws without the volume term
  double kappa_ = 0;               ///< of the volume term [Pa]
  std::function<VolumeDensity(double J)> density_;
  std::vector<char> fixed_;
  double unit_length_ = 1, unit_pressure_ = 1;
  BlockMatrix K_;  ///< stiffness at constant pressures [N/m]
  /// (u, p) of (f, g) by one cycle of the mixed multigrid of the rest state, in units of G and the cells' edge.
  std::function<void(const Eigen::VectorXd& f, const Eigen::VectorXd& g, Eigen::VectorXd& u, Eigen::VectorXd& p)>
      precondition_;
  Eigen::VectorXd rest_volume_;  ///< of the filled part of each cell [m^3]
  Eigen::VectorXd p_, accepted_p_;
  int iterations_ = 0;
};

}  // namespace springproof
