// Newton's method with the pressure of each cell as an unknown: large displacements near nu = 1/2.
#pragma once

#include <functional>
#include <memory>

#include "msm/algebra/saddle_point.h"
#include "msm/embedding/boundary.h"
#include "msm/laws/laws.h"

namespace springproof {

/// Finds x and p of   f_springs(x) + sum_c p_c dV_c/dx = external,   psi'(V_c/V) = p_c / kappa,  psi the volume term of
/// the model (msm/laws/volume_correction.h, strain_energy.h) and V the volume of the filled part of a cell; p_c = 0 in
/// cells of materials without one (mixed_parts, msm/laws/averaged_springs.h).  A guess
/// with a wrong volume then causes no forces of kappa times the error, which impede the form without p.  Steps are
/// solved by GMRES preconditioned by the mixed multigrid of the rest state.
class MixedNewton {
 public:
  /// For a lattice with a volume term per cell (mixed_form.h), which must outlive it.
  MixedNewton(const MassSpringModel& model, const std::vector<char>& fixed);

  /// Moves x, from the pressures of the step accepted last, to equilibrium under the conditions.
  /// @return false if it is not reached in max_iterations.
  bool step(const BoundaryConditions& conditions, double tolerance, int max_iterations, NodalVectors& x);
  void accept() { accepted_p_ = p_; }             ///< accepts the last step
  int iterations() const { return iterations_; }  ///< so far

 private:
  class Linearised;
  Linearised linearise(const NodalVectors& x, const Eigen::VectorXd& external);  ///< also assembles K_
  MixedVector solve(Linearised& at, const Eigen::VectorXd& r, const Eigen::VectorXd& h, double tolerance) const;

  const Network& network_;
  std::vector<ForceLaw> springs_;                                ///< the laws without the volume term
  std::vector<std::function<VolumeDensity(double J)>> density_;  ///< of the volume term of each material
  std::vector<char> fixed_;
  double unit_length_ = 1, unit_pressure_ = 1;
  BlockMatrix K_;                      ///< stiffness at constant pressures [N/m]
  std::unique_ptr<SaddlePoint> rest_;  ///< at rest, in units of G and the cells' edge: preconditions
  Eigen::VectorXd rest_volume_;        ///< of the filled part of each cell [m^3]
  Eigen::VectorXd kappa_;              ///< of the volume term of each cell [Pa]; 0: it has no pressure
  Eigen::VectorXd p_, accepted_p_;
  int iterations_ = 0;
};

}  // namespace springproof
