// The time step of a motion, and whether a model can be moved as its options say.
#pragma once

#include <string>

#include "msm/dynamics/motion.h"
#include "problem/system/input_error.h"

namespace springproof {

/// An option of a motion that is refused.  what() reads "time_step_s: what is wrong, what is allowed".
class MotionOptionError : public InputError {
 public:
  /// @param option its name, as case files have it
  /// @param reason what is wrong, what is allowed
  MotionOptionError(const std::string& option, const std::string& reason)
      : InputError(option + ": " + reason), option_(option) {}

  const std::string& option() const { return option_; }

 private:
  std::string option_;
};

/// Default of explicit steps, relative to viscous_time_step().
inline constexpr double share_of_bound = 0.95;

/// The time step of a motion: MotionOptions::time_step, or share_of_bound of viscous_time_step(), of large steps 10
/// times safe_time_step().
/// @param model a model
/// @param density [kg/m^3]
/// @param options any
/// @return the step [s]
/// @throws MotionOptionError if the explicit time step exceeds viscous_time_step(), if the integrator or viscosity or a
///   share of consistent mass does not suit the model or other options, if the damping is negative, or, lagged, not
///   above lagged_damping(); the bound is in the message.
double checked_time_step(const MassSpringModel& model, double density, const MotionOptions& options);

/// Smallest damping [1/s] with which lagged dispersion is stable: step * omega*^2, omega* a bound on what dispersion
/// adds (dispersion_frequency_squared()).  For a mode of frequencies omega_s (springs) and omega* the step has the
/// characteristic equation (1 + c dt) z^2 - (2 + c dt - dt^2 omega_s^2) z + (1 + dt^2 omega*^2) = 0, and the product of
/// its roots is below 1 only if c > dt omega*^2; for matrices the same holds with Rayleigh quotients, hence for every
/// motion.  0 for a negative dispersed fraction, which the lag itself damps.  Non-conservative forms may need more.
/// @param model a model
/// @param density [kg/m^3]
/// @param time_step [s]
/// @return damping [1/s]; 0 without momentum dispersion
double lagged_damping(const MassSpringModel& model, double density, double time_step);

}  // namespace springproof
