// Dynamics: the semi-implicit Euler method of Golec et al. (2019), with a time step that is checked, or implicit steps.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "msm/dynamics/checked_step.h"
#include "msm/dynamics/motion.h"
#include "msm/dynamics/terms/plane_contact.h"
#include "msm/statics/equilibrium.h"
#include "problem/course.h"

namespace springproof {

/// A motion at a time.
struct MotionSample {
  double time;                                  ///< [s]
  const NodalVectors& x;                        ///< positions [m]
  const NodalVectors& v;                        ///< velocities of the step [m/s]
  const BoundaryConditions& conditions;         ///< then
  const NodalVectors& relaxing;                 ///< Motion::relaxing_forces() [N]
  std::optional<BranchEnergies> energies = {};  ///< Motion::branch_energies()
};

/// How to move a model in time.
struct DynamicsOptions : MotionOptions {
  NodalVectors start = {};     ///< positions at t = 0 [m]; empty: X
  NodalVectors velocity = {};  ///< at t = 0 [m/s], for which the first explicit step is of second order too; empty:
                               ///< that step starts from rest, as published
  Course course = {};          ///< of the loads and supports
  double duration = 10;        ///< [s]
  double rest_tolerance = 0;   ///< stop when relative unbalanced force and damping dt |v|/|u| are below; 0 = never
  std::function<void(const MotionSample&)> after_step = {};  ///< called after every `stride` steps and after the last
  long stride = 1;                                           ///< steps between two calls of after_step
};

/// How a motion ended.
struct DynamicsResult {
  Equilibrium state;          ///< final state; ok if at rest within rest_tolerance, or if rest_tolerance is 0
  double time = 0;            ///< [s]
  double time_step = 0;       ///< [s]
  long steps = 0;             ///< made
  double kinetic_energy = 0;  ///< [J]
};

/// In the fastest way that there is for the model: large steps, kernels (LatticeMotion, ListMotion), else plain loops.
/// @param model a model, to which a reference is kept
/// @param density [kg/m^3]
/// @param options with the time step of checked_time_step()
/// @return the motion, at rest at X
std::unique_ptr<Motion> make_motion(const MassSpringModel& model, double density, const MotionOptions& options);

/// The velocity that a motion is set to at its start: of explicit steps half a step before the positions, v - dt a / 2,
/// of momenta if these are averaged.
/// @param model a model
/// @param density [kg/m^3]
/// @param x positions [m], n x 3
/// @param bc supports and loads then
/// @param options with a time step, of which velocity, integrator, damping, viscosity and mass_consistency are read
/// @return for Motion::set_state() [m/s], n x 3; zero if DynamicsOptions::velocity is empty
NodalVectors velocity_before(const MassSpringModel& model, double density, const NodalVectors& x,
                             const BoundaryConditions& bc, const DynamicsOptions& options);

/// Integrates v += dt (f/m - damping v), x += dt v (the damping implicit) with prescribed unknowns on their path, or by
/// an implicit method (ImplicitMotion).
/// Models that have a kernel (make_motion()) use it.  Rest is checked every few steps.
/// @param model a model
/// @param density [kg/m^3]
/// @param load_path conditions at a fraction of the loads, which DynamicsOptions::course gives in time
/// @param options integrator, step, duration, what is called after steps
/// @return the last state
/// @throws MotionOptionError as checked_time_step().
DynamicsResult run_dynamics(const MassSpringModel& model, double density, const LoadPath& load_path,
                            const DynamicsOptions& options);

}  // namespace springproof
