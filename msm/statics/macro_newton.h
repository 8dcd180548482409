// Newton's method with four pressures per macro-cell as unknowns: large displacements near nu = 1/2.
#pragma once

#include "msm/multigrid/macro_solver.h"
#include "msm/statics/mixed_newton.h"

namespace springproof {

/// Finds x and p of  dE_springs/dx + D^T p = external,  kappa V d<U>/dtheta = p  (msm/laws/macro_pressures.h).
class MacroNewton : public PressureNewton {
 public:
  /// Whether the model is one of macro-cells for which this form is worthwhile.
  static bool suits(const MassSpringModel& model);

  MacroNewton(const MassSpringModel& model, const std::vector<char>& fixed);

  bool step(const BoundaryConditions& conditions, double tolerance, int max_iterations, NodalVectors& x) override;
  void accept() override { accepted_p_ = p_; }
  int iterations() const override { return iterations_; }
  std::string name() const override { return "GMRES + multigrid of averaged springs, with pressures"; }

 private:
  const Network& network_;
  std::vector<char> fixed_;
  MacroSolver solver_;
  Eigen::VectorXd p_, accepted_p_;  ///< [Pa m^3]
  int iterations_ = 0;
};

}  // namespace springproof
