// Explicit dynamics: the semi-implicit Euler method of Golec et al. (2019), with a time step that is checked.
#pragma once

#include <optional>

#include "msm/solve/equilibrium.h"

namespace springproof {

struct DynamicsOptions {
  std::optional<double> time_step;   ///< [s]; empty: 0.95 of safe_time_step()
  double damping = 0;                ///< mass-proportional, force -damping * m * v [1/s]
  double ramp = 0;                   ///< the load grows linearly over this time [s]; 0 = at once
  double duration = 10;              ///< [s]
  double rest_tolerance = 0;         ///< stop when unbalanced and inertial forces fall below this fraction; 0 = never
};

struct DynamicsResult {
  Equilibrium state;          ///< at the end; ok if at rest within rest_tolerance, or if the duration was the aim
  double time = 0;            ///< [s]
  double time_step = 0;       ///< [s]
  long steps = 0;
  double kinetic_energy = 0;  ///< [J]
};

/// Steps v += dt (f/m - damping v), x += dt v (the damping implicit), prescribed unknowns on their path.
/// @throws InputError if the time step exceeds safe_time_step() (the bound is in the message), or if the damping is
///   negative.
DynamicsResult run_dynamics(const MassSpringModel& model, double density, const LoadPath& load_path,
                            const DynamicsOptions& options);

}  // namespace springproof
