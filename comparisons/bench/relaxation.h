// The usual baseline of a static mass-spring solver: damped dynamics until rest.
#pragma once

#include "msm/statics/equilibrium.h"

namespace springproof::bench {

struct Relaxation {
  bool at_rest = false;
  long steps = 0;
  double seconds = 0;  ///< CPU time of the steps; finding the damping is not counted
  std::string message;
};

/// run_dynamics() from rest with the largest safe step and the best mass-proportional damping, 2 sqrt(lmin), lmin the
/// smallest squared frequency [1/s^2] of the linearised model, until the unbalanced force falls below the tolerance.
/// `factor` multiplies that damping.
Relaxation relax(const MassSpringModel& model, const BoundaryConditions& conditions, double tolerance,
                 double factor = 1);

}  // namespace springproof::bench
