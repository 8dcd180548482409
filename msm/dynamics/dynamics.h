// Dynamics: the semi-implicit Euler method of Golec et al. (2019), with a time step that is checked, or implicit steps.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "msm/dynamics/implicit_motion.h"
#include "msm/dynamics/lattice_motion.h"
#include "msm/dynamics/mass_average.h"
#include "msm/dynamics/plane_contact.h"
#include "msm/dynamics/viscosity.h"
#include "msm/statics/equilibrium.h"
#include "problem/course.h"

namespace springproof {

/// Name of an integrator, for people.
/// @param integrator any
/// @return "energy-momentum"
const char* name_of(Integrator integrator);

/// How to move a model in time.
struct DynamicsOptions {
  Integrator integrator = Integrator::explicit_euler;  ///< explicit, or one that takes large steps
  std::optional<double> time_step;                     ///< [s]; empty: 0.95 of safe_time_step(), implicit: 10 of it
  NodalVectors start;                                  ///< positions at t = 0 [m]; empty: X
  NodalVectors velocity;  ///< at t = 0 [m/s], for which the first explicit step is of second order too; empty: that
                          ///< step starts from rest, as published
  double damping = 0;   ///< mass-proportional, force -damping * m * v [1/s]; non-conservative momentum dispersion needs
                        ///< some, or it flutters
  Viscosity viscosity;  ///< by kernels that of cells
  double mass_consistency = 0;      ///< share of consistent mass of explicit steps, 0 to 1: MassAverage.  With it every
                                    ///< velocity v of a step, of Motion too, is the momentum over the lumped mass
  PlaneContact* contact = nullptr;  ///< a plane that the body may fall on, for explicit steps; nullptr: there is none
  Course course;                    ///< of the loads and supports
  double duration = 10;             ///< [s]
  double rest_tolerance = 0;        ///< stop when relative unbalanced force and damping dt |v|/|u| are below; 0 = never
  Precision precision = Precision::float64;  ///< of the kernels; the plain loops use float64
  int threads = 1;                           ///< of the kernels; the plain loops and momentum dispersion use one
  bool lagged = false;  ///< dispersion uses the J of the previous step; Kot & Nagahashi (2015), sec. 7
  /// Called after every `stride` steps and after the last, with the time, the positions [m], the velocity of the step
  /// [m/s] and the boundary conditions then.
  std::function<void(double time, const NodalVectors& x, const NodalVectors& v, const BoundaryConditions& conditions)>
      after_step = {};
  long stride = 1;  ///< steps between two calls of after_step
};

/// How a motion ended.
struct DynamicsResult {
  Equilibrium state;          ///< final state; ok if at rest within rest_tolerance, or if rest_tolerance is 0
  double time = 0;            ///< [s]
  double time_step = 0;       ///< [s]
  long steps = 0;             ///< made
  double kinetic_energy = 0;  ///< [J]
};

/// A model in motion, step by step.
class Motion {
 public:
  virtual ~Motion() = default;
  /// Sets supports and loads of the following steps; fixed unknowns are moved at the end of the first of them.
  /// @param conditions supports and loads
  virtual void set_conditions(const BoundaryConditions& conditions) = 0;
  /// Moves the supports to their places immediately.
  virtual void move_supports() = 0;
  /// Sets the state.
  /// @param x positions [m], n x 3
  /// @param v velocities [m/s], n x 3
  virtual void set_state(const NodalVectors& x, const NodalVectors& v) = 0;
  /// Makes steps.
  /// @param steps how many
  /// @return the norms of forces at the beginning of the last step
  virtual ForceNorms advance(long steps) = 0;
  /// @return positions [m], n x 3
  virtual NodalVectors positions() const = 0;
  /// @return velocities [m/s], n x 3
  virtual NodalVectors velocities() const = 0;
  /// @return the integrator and kernel in words
  virtual std::string description() const = 0;
  /// @return why the last advance() has no result; empty: it has one
  virtual std::string failure() const { return ""; }
};

/// The time step of a motion: DynamicsOptions::time_step, or the default.
/// @param model a model
/// @param density [kg/m^3]
/// @param options integrator and step
/// @return the step [s]
/// @throws InputError as run_dynamics().
double checked_time_step(const MassSpringModel& model, double density, const DynamicsOptions& options);

/// At rest at X, in the fastest way that there is for the model: kernels (LatticeMotion, ListMotion), else plain loops.
/// @param model a model, to which a reference is kept
/// @param density [kg/m^3]
/// @param time_step [s], of checked_time_step()
/// @param options of which integrator, damping, viscosity, mass_consistency, precision, threads and lagged are read
/// @return the motion, at rest
std::unique_ptr<Motion> make_motion(const MassSpringModel& model, double density, double time_step,
                                    const DynamicsOptions& options);

/// The velocity that a motion is set to at its start: of explicit steps half a step before the positions, v - dt a / 2,
/// of momenta if these are averaged.
/// @param model a model
/// @param density [kg/m^3]
/// @param x positions [m], n x 3
/// @param bc supports and loads then
/// @param dt the step [s]
/// @param options of which velocity, integrator, damping, viscosity and mass_consistency are read
/// @return for Motion::set_state() [m/s], n x 3; zero if DynamicsOptions::velocity is empty
NodalVectors velocity_before(const MassSpringModel& model, double density, const NodalVectors& x,
                             const BoundaryConditions& bc, double dt, const DynamicsOptions& options);

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

/// Integrates v += dt (f/m - damping v), x += dt v (the damping implicit) with prescribed unknowns on their path, or by
/// an implicit method (ImplicitMotion).
/// Models that have a kernel (make_motion()) use it.  Rest is checked every few steps.
/// @param model a model
/// @param density [kg/m^3]
/// @param load_path conditions at a fraction of the loads, which DynamicsOptions::course gives in time
/// @param options integrator, step, duration, what is called after steps
/// @return the last state
/// @throws InputError if the explicit time step exceeds safe_time_step() or viscous_time_step(), if the integrator or
///   viscosity or a share of consistent mass does not suit the model or other options, if the damping is negative, or,
///   lagged, not above lagged_damping(); the bound is in the message.
DynamicsResult run_dynamics(const MassSpringModel& model, double density, const LoadPath& load_path,
                            const DynamicsOptions& options);

}  // namespace springproof
