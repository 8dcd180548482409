#include "comparisons/models/motion_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "comparisons/prepare/load_resultants.h"
#include "comparisons/prepare/sampling.h"
#include "msm/dynamics/inertia.h"
#include "msm/dynamics/terms/mass_average.h"
#include "msm/laws/capabilities.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

/// Records the motion of one network, sample by sample.
class MotionRecorder {
 public:
  /// Keeps references to all but the options.
  MotionRecorder(const MovingNetwork& moving, const MotionOptions& options, MotionRecord& record)
      : moving_(moving),
        mass_(moving.masses()),
        per_mass_(inverse_inertia(moving.network(), moving.material.density, options)),
        behind_(options.integrator == Integrator::explicit_euler ? options.time_step.value() / 2 : 0),
        damping_(options.damping),
        viscosity_(options.viscosity),
        average_(mass_average(moving.network(), moving.material.density, options)),
        contact_(options.contact),
        cut_(moving.lattice.cut && moving.network().cells.cut()),
        record_(record) {}

  void operator()(const MotionSample& now) {
    const MassSpringModel& model = moving_.built.model;
    const NodalVectors s = at_positions(now), v = average_.velocities(s, now.conditions.fixed);
    record_.history.time.push_back(now.time);
    const Field field = field_at(now, v);
    next_ = 0;
    add("kinetic_energy", "J", 0.5 * (s.cwiseProduct(v).rowwise().sum().array() * mass_.array()).sum());
    if (can(model, Capability::energy)) add("elastic_energy", "J", energy(model, now.x));
    if (now.energies) {
      add("branch_energy", "J", now.energies->stored);
      add("dissipated_energy", "J", now.energies->dissipated);
    }
    add_momenta(now.x, s);
    const NodalVectors u = now.x - model.network.X;
    add("load_potential", "J", -now.conditions.external.cwiseProduct(u).sum());
    add("volume_change", "1", cut_ ? volume_change(model.network, u).exact : field.volume_change);
    for (const PatchReaction& r : field.reactions) add_vector("force." + r.patch, "N", r.force);
    if (contact_) add_impulse(contact_->take_impulse());
    add_probes(u, field);
    const MotionChoice& motion = moving_.motion();
    if (now.time * motion.frames >= (record_.frames.size() + 1) * motion.duration * (1 - 1e-9))
      record_.frames.emplace_back(now.time, field.displacement);
  }

 private:
  /// The velocity at the time of the positions: that of explicit steps is half a step behind.
  NodalVectors at_positions(const MotionSample& now) const {
    NodalVectors v = now.v;
    if (behind_ == 0) return v;
    const std::vector<char>& fixed = now.conditions.fixed;
    const NodalVectors f = forces(moving_.built.model, now.x) + forces_beside(now, average_.velocities(v, fixed)) +
                           now.conditions.external;
    for (Eigen::Index i = 0; i < v.size(); ++i)
      if (!fixed[i]) v.data()[i] += behind_ * (f.data()[i] * per_mass_.data()[i] - damping_ * v.data()[i]);
    if (contact_) v = contact_->stopped(fixed, v);
    carry(moving_.network().cells.carried, v);
    return v;
  }

  /// Of dashpots and branches.
  NodalVectors forces_beside(const MotionSample& now, const NodalVectors& v) const {
    NodalVectors f = NodalVectors::Zero(now.x.rows(), 3);
    if (viscosity_.acts()) viscosity_.add_forces(moving_.network(), now.x, v, f);
    if (now.relaxing.size() > 0) f += now.relaxing;
    return f;
  }

  Field field_at(const MotionSample& now, const NodalVectors& v) const {
    const MassSpringModel& model = moving_.built.model;
    const PreparedCase& prepared = moving_.prepared;
    Equilibrium state;
    state.displacement = now.x - model.network.X;
    state.support = support_forces(model, now.x, now.conditions);
    const NodalVectors beside = forces_beside(now, v);
    for (Eigen::Index i = 0; i < beside.size(); ++i)
      if (now.conditions.fixed[i]) state.support.data()[i] -= beside.data()[i];
    const Experiment& e = prepared.experiment;
    Field field = to_field(state, moving_.lattice.mesh, moving_.built.embedding, model.network, prepared.loads,
                           now.conditions, e.model_kinematics());
    if (e.body.is_voxels()) field.reactions = about_true_patches(prepared, *moving_.lattice.mesh, field.reactions);
    return field;
  }

  /// About the origin.
  void add_momenta(const NodalVectors& x, const NodalVectors& s) {
    add_vector("linear_momentum", "kg m/s", s.transpose() * mass_);
    Vec3 spin = Vec3::Zero();
    for (Eigen::Index n = 0; n < x.rows(); ++n)
      spin += mass_[n] * Vec3(x.row(n).transpose()).cross(Vec3(s.row(n).transpose()));
    add_vector("angular_momentum", "kg m^2/s", spin);
  }

  void add_probes(const NodalVectors& u, const Field& field) {
    const PreparedCase& prepared = moving_.prepared;
    const std::vector<Probe>& probes = prepared.experiment.probes;
    const NodalVectors at_points = cut_ ? displacement_at(*moving_.lattice.cut, u, measured_points(prepared))
                                        : at_measured_points(prepared, moving_.lattice, field.displacement);
    for (std::size_t p = 0; p < probes.size(); ++p)
      add_vector("displacement." + probes[p].name, "m", at_points.row(static_cast<Eigen::Index>(p)).transpose());
  }

  void add(const std::string& name, const char* unit, double value) {
    HistoryRecord& h = record_.history;
    if (next_ == h.names.size()) {
      h.names.push_back(name);
      h.units.emplace_back(unit);
      h.values.emplace_back();
    }
    h.values[next_++].push_back(value);
  }

  void add_vector(const std::string& name, const char* unit, const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) add(fmt::format("{}.{}", name, "xyz"[axis]), unit, v[axis]);
  }

  void add_impulse(const ContactImpulse& further) {
    add_vector("contact_impulse", "N s", impulse_.linear += further.linear);
    add_vector("contact_angular_impulse", "N m s", impulse_.angular += further.angular);
  }

  MovingNetwork moving_;
  Eigen::VectorXd mass_;
  NodalVectors per_mass_;  ///< of masses and support masses
  double behind_;          ///< the velocities of a step [s]
  double damping_;         ///< [1/s]
  Viscosity viscosity_;
  MassAverage average_;
  PlaneContact* contact_;   ///< nullptr: there is no plane
  ContactImpulse impulse_;  ///< of the plane on the body so far
  bool cut_;                ///< the network is of cut cells of the lattice
  MotionRecord& record_;
  std::size_t next_ = 0;  ///< quantity
};

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
