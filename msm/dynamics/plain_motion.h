// Time integration of any model by the plain force loops.
#pragma once

#include "msm/dynamics/motion.h"
#include "msm/dynamics/terms/mass_average.h"

namespace springproof {

/// The steps of run_dynamics() as they are written: for models that have no kernel, and what kernels are held against.
/// Its branches are those at the beginning of the last step.
class PlainMotion : public MotionOfNodes {
 public:
  /// @param model a model
  /// @param density [kg/m^3]
  /// @param options with a time step, of which damping, viscosity, relaxation, mass_consistency and lagged are read
  PlainMotion(const MassSpringModel& model, double density, const MotionOptions& options);

  void set_conditions(const BoundaryConditions& conditions) override { conditions_ = conditions; }
  NodalVectors relaxing_forces() const override;
  std::optional<BranchEnergies> branch_energies() const override;
  ForceNorms advance(long steps) override;
  std::string description() const override { return "plain loops"; }

 private:
  ForceNorms step();
  NodalVectors moving() const;
  NodalVectors forces_at_x();

  const MomentumDispersion* dispersion_;  ///< nullptr: dispersion is not lagged
  NodalVectors inverse_inertia_;          ///< [1/kg]
  Eigen::VectorXd J_;
  double dt_, damping_;
  Viscosity viscosity_;
  bool energies_wanted_;
  MassAverage average_;
  NodalVectors of_supports_;  ///< velocities of moved unknowns [m/s], zero on free ones
};

}  // namespace springproof
