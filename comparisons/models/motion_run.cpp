#include "comparisons/models/motion_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "comparisons/models/motion_measured.h"
#include "comparisons/models/motion_steps.h"
#include "msm/dynamics/dynamics.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

/// That of the whole body, about its centre of mass.
NodalVectors rigid_velocity(const MotionChoice& motion, const Network& network, const Eigen::VectorXd& mass) {
  const Vec3 centre = network.X.transpose() * mass / mass.sum();
  NodalVectors v(network.X.rows(), 3);
  for (Eigen::Index n = 0; n < v.rows(); ++n)
    v.row(n) = (motion.velocity + motion.spin.cross(Vec3(network.X.row(n).transpose()) - centre)).transpose();
  return v;
}

void measure_bounce(const PlaneContact& contact, HistoryRecord& history) {
  const auto bounce = contact.bounce();
  if (!bounce) return;
  history.measured["contact_time"] = bounce->end - bounce->begin;
  history.measured["restitution"] = -bounce->velocity_after / bounce->velocity_before;
}

}  // namespace

Equilibrium run_motion(const MovingNetwork& moving, const LoadPath& path, MotionRecord& record) {
  const MotionChoice& motion = moving.motion();
  const MassSpringModel& model = moving.built.model;
  const MotionSteps steps = steps_of(moving.prepared.experiment, model, moving.material);
  const double dt = *steps.options.time_step;
  record.history.time_step = dt;
  record.history.integrator = name_of(steps.options.integrator);
  std::optional<PlaneContact> contact;
  if (motion.plane)
    contact.emplace(*motion.plane, moving.masses(), std::max(motion.duration / motion.samples, 5 * dt),
                    moving.built.embedding.surface);
  DynamicsOptions options{steps.options};
  options.contact = contact ? &*contact : nullptr;
  options.course = motion.course;
  options.duration = motion.duration;
  options.stride = steps.stride;
  options.branch_energies = options.relaxation.acts();
  options.velocity = rigid_velocity(motion, model.network, moving.masses());
  MotionRecorder recorder(moving, options, record);
  options.after_step = [&](const MotionSample& now) {
    recorder(now);
    progress::detail(fmt::format("{:.3g} of {:.3g} s", now.time, motion.duration));
  };
  LoadPath in_time = path;
  if (motion.released) {
    const Equilibrium start = solve_finite(model, path);
    if (!start.ok) return start;
    options.start = model.network.X + start.displacement;
    in_time = [&](double factor) {
      BoundaryConditions bc = path(1.0);
      bc.external *= 1 - factor;
      return bc;
    };
  }
  Equilibrium state = run_dynamics(model, moving.material.density, in_time, options).state;
  measure(moving, in_time(1.0), record.history);
  if (contact) measure_bounce(*contact, record.history);
  return state;
}

}  // namespace springproof
