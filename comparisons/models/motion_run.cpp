#include "comparisons/models/motion_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comparisons/judge/swings.h"
#include "comparisons/prepare/sampling.h"
#include "comparisons/prepare/voxel_body.h"
#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/time_step.h"
#include "msm/laws/filled_volume.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

constexpr double most_steps = 1e8;
constexpr double implicit_ratio = 10;  // default step of implicit methods to the explicit bound
// Ratio of a wanted step to the explicit bound, above which "auto" takes it (docs/motion.md).
constexpr double worthwhile_ratio = 50, worthwhile_ratio_beside_kernels = 500;

/// The steps of a motion.
struct Steps {
  Integrator integrator;
  double size;  ///< [s]
  long stride;  ///< from one sample of the history to the next
};

Integrator integrator_of(const MotionChoice& motion, const MassSpringModel& model, const Viscosity& viscosity,
                         double bound) {
  const bool cut = !model.network.filled.empty(), only_explicit = motion.plane && (cut || motion.plane->friction > 0);
  if (motion.integrator == "explicit" || (only_explicit && motion.integrator == "auto"))
    return Integrator::explicit_euler;
  if (only_explicit)
    throw InputError(
        motion.integrator_where,
        fmt::format("dynamics.integrator: {} has a plane for nodes, not for the surface of the cut cells of "
                    "a model of the case (allowed for it: explicit, auto; or cut = false)",
                    motion.integrator));
  if (motion.integrator == "implicit_euler") return Integrator::implicit_euler;
  const std::string why = EnergyMomentum::lacks(model);
  if (motion.integrator == "auto") {
    const double wanted = motion.time_step.value_or(motion.duration / std::max(motion.frames, 1));
    const double ratio = LatticeMotion::suits(model, viscosity) ? worthwhile_ratio_beside_kernels : worthwhile_ratio;
    return why.empty() && wanted > ratio * bound ? Integrator::energy_momentum : Integrator::explicit_euler;
  }
  if (!why.empty())
    throw InputError(motion.integrator_where,
                     fmt::format("dynamics.integrator: energy_momentum does not suit a model of the case: {} (allowed "
                                 "for it: explicit, implicit_euler)",
                                 why));
  return Integrator::energy_momentum;
}

Steps steps_of(const MotionChoice& motion, const MassSpringModel& model, const IsotropicMaterial& material) {
  const Viscosity viscosity = Viscosity::of(model, material, motion.viscosity);
  const double theta = motion.mass_consistency;
  if (const std::string why = theta > 0 ? MassAverage::lacks(model.network) : ""; !why.empty())
    throw InputError(
        motion.mass_where,
        fmt::format("dynamics.mass_consistency: does not suit a model of the case: {} (allowed for it: 0)", why));
  const double safe = safe_time_step(model, material.density, false, theta),
               bound = viscous_time_step(model, material.density, viscosity, safe, theta);
  const Integrator integrator = integrator_of(motion, model, viscosity, bound);
  const bool implicit = integrator != Integrator::explicit_euler, chosen = motion.integrator == "auto";
  double size = motion.time_step.value_or(!implicit ? 0.95 * bound
                                          : chosen  ? motion.duration / std::max(motion.frames, 1)
                                                   : std::min(implicit_ratio * safe, motion.duration / motion.samples));
  if (chosen && !implicit) size = std::min(size, 0.95 * bound);
  if (size > bound && !implicit)
    throw InputError(
        motion.where,
        fmt::format("dynamics.time_step_s: {:.6g} s is not safe for a model of the case at nu = {} "
                    "(allowed: up to {:.6g} s, the bound of its springs and cells, or no time_step_s: each "
                    "model then has its own; or integrator = \"energy_momentum\")",
                    size, material.poisson_ratio, bound));
  const double count = std::ceil(motion.duration / size);
  if (count > most_steps)
    throw InputError(motion.where, fmt::format("dynamics.duration_s: takes {:.3g} steps of {:.3g} s (allowed: up to "
                                               "{:.0g} steps)",
                                               count, size, most_steps));
  return {integrator, size, std::max(1L, static_cast<long>(count) / motion.samples)};
}

/// Records the motion of one network, sample by sample.
class Recorder {
 public:
  Recorder(const PreparedCase& prepared, const Lattice& lattice, const EmbeddedModel& built,
           const IsotropicMaterial& material, const Steps& steps, const DynamicsOptions& options, MotionRecord& record)
      : prepared_(prepared),
        lattice_(lattice),
        built_(built),
        mass_(masses(built.model.network, material.density)),
        per_mass_(inverse_masses(built.model.network, material.density)),
        behind_(steps.integrator == Integrator::explicit_euler ? steps.size / 2 : 0),
        damping_(options.damping),
        viscosity_(options.viscosity),
        average_(built.model.network, options.mass_consistency),
        contact_(options.contact),
        cut_(lattice.cut && !built.model.network.filled.empty()),
        record_(record) {}

  void operator()(double time, const NodalVectors& x, const NodalVectors& of_step,
                  const BoundaryConditions& conditions) {
    const NodalVectors s = at_positions(x, of_step, conditions), v = average_.velocities(s, conditions.fixed);
    record_.history.time.push_back(time);
    const Field field = field_at(x, v, conditions);
    next_ = 0;
    add("kinetic_energy", "J", 0.5 * (s.cwiseProduct(v).rowwise().sum().array() * mass_.array()).sum());
    if (conservative(built_.model)) add("elastic_energy", "J", energy(built_.model, x));
    add_vector("linear_momentum", "kg m/s", s.transpose() * mass_);
    Vec3 spin = Vec3::Zero();
    for (Eigen::Index n = 0; n < x.rows(); ++n)
      spin += mass_[n] * Vec3(x.row(n).transpose()).cross(Vec3(s.row(n).transpose()));
    add_vector("angular_momentum", "kg m^2/s", spin);
    const NodalVectors u = x - built_.model.network.X;
    add("load_potential", "J", -conditions.external.cwiseProduct(u).sum());
    add("volume_change", "1", cut_ ? volume_change(built_.model.network, u).exact : field.volume_change);
    for (const PatchReaction& r : field.reactions) add_vector("force." + r.patch, "N", r.force);
    if (contact_) add_impulse(contact_->take_impulse());
    const std::vector<Probe>& probes = prepared_.experiment.probes;
    const NodalVectors at_points = cut_ ? displacement_at(*lattice_.cut, u, measured_points(prepared_))
                                        : at_measured_points(prepared_, lattice_, field.displacement);
    for (std::size_t p = 0; p < probes.size(); ++p)
      add_vector("displacement." + probes[p].name, "m", at_points.row(static_cast<Eigen::Index>(p)).transpose());
    const MotionChoice& motion = *prepared_.experiment.dynamics;
    if (time * motion.frames >= (record_.frames.size() + 1) * motion.duration * (1 - 1e-9))
      record_.frames.emplace_back(time, field.displacement);
  }

 private:
  /// The velocity at the time of the positions: that of explicit steps is half a step behind.
  NodalVectors at_positions(const NodalVectors& x, NodalVectors v, const BoundaryConditions& conditions) const {
    if (behind_ == 0) return v;
    const NodalVectors f =
        forces(built_.model, x) + viscous_forces(x, average_.velocities(v, conditions.fixed)) + conditions.external;
    for (Eigen::Index i = 0; i < v.size(); ++i)
      if (!conditions.fixed[i]) v.data()[i] += behind_ * (f.data()[i] * per_mass_[i / 3] - damping_ * v.data()[i]);
    if (contact_) v = contact_->stopped(conditions.fixed, v);
    carry(built_.model.network.carried, v);
    return v;
  }

  NodalVectors viscous_forces(const NodalVectors& x, const NodalVectors& v) const {
    NodalVectors f = NodalVectors::Zero(x.rows(), 3);
    if (viscosity_.acts()) viscosity_.add_forces(built_.model.network, x, v, f);
    return f;
  }

  Field field_at(const NodalVectors& x, const NodalVectors& v, const BoundaryConditions& conditions) const {
    const MassSpringModel& model = built_.model;
    Equilibrium state;
    state.displacement = x - model.network.X;
    state.support = support_forces(model, x, conditions);
    const NodalVectors viscous = viscous_forces(x, v);
    for (Eigen::Index i = 0; i < viscous.size(); ++i)
      if (conditions.fixed[i]) state.support.data()[i] -= viscous.data()[i];
    const Experiment& e = prepared_.experiment;
    Field field = to_field(state, lattice_.mesh, built_.embedding, model.network, prepared_.loads, conditions,
                           e.model_kinematics());
    if (e.body.is_voxels()) field.reactions = about_true_patches(prepared_, *lattice_.mesh, field.reactions);
    return field;
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

  const PreparedCase& prepared_;
  const Lattice& lattice_;
  const EmbeddedModel& built_;
  Eigen::VectorXd mass_, per_mass_;
  double behind_;   ///< the velocities of a step [s]
  double damping_;  ///< [1/s]
  Viscosity viscosity_;
  MassAverage average_;
  PlaneContact* contact_;   ///< nullptr: there is no plane
  ContactImpulse impulse_;  ///< of the plane on the body so far
  bool cut_;                ///< the network is of cut cells of the lattice
  MotionRecord& record_;
  std::size_t next_ = 0;  ///< quantity
};

}  // namespace

void check_motion(const MotionChoice& motion, const MassSpringModel& model, const IsotropicMaterial& material) {
  steps_of(motion, model, material);
}

const std::vector<double>* series(const HistoryRecord& h, const std::string& name) {
  const auto at = std::find(h.names.begin(), h.names.end(), name);
  return at == h.names.end() ? nullptr : &h.values[at - h.names.begin()];
}

namespace {

/// By how much a body of corner masses turns too slowly: the largest excess of their moments of inertia about x, y and
/// z over those of its cells, as a fraction of these.  A corner's mass has l^2 / 4 about the middle of a cell, the cell
/// l^2 / 12; a share of consistent mass has the cell's.
double inertia_excess(const Network& network, const Eigen::VectorXd& mass, double mass_consistency) {
  double volume = 0;
  Vec3 own = Vec3::Zero();
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const double V = filled_volume(network, c);
    volume += V;
    own += V * (network.edge(c) * network.proportions).array().square().matrix() / 6;
  }
  own *= mass.sum() / volume;
  const Eigen::RowVector3d centre = mass.transpose() * network.X / mass.sum();
  const Vec3 second = (network.X.rowwise() - centre).array().square().matrix().transpose() * mass;
  double most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double excess = own.sum() - own[axis], all = second.sum() - second[axis];
    most = std::max(most, (1 - mass_consistency) * excess / (all - excess));
  }
  return most;
}

/// Period and amplitude of the first probe, and what is conserved: the energy of undamped motions after the loads have
/// their final size, the momentum along axes in which nothing is held or loaded.
void measure(const Experiment& e, const MotionChoice& motion, const Network& network, const Eigen::VectorXd& masses,
             double body_size, const BoundaryConditions& last, HistoryRecord& h) {
  std::size_t first = 0;
  const double settled = motion.course.settled();  // the loads of a sample are those of the step before it
  while (first < h.time.size() && settled > 0 && h.time[first] < settled + h.time_step) ++first;
  if (!e.probes.empty() && h.time.size() > 1) {
    h.probe = liveliest(h, e.probes.front().name);
    h.measured = measured_in_time(motion, h);
  }
  const std::vector<double>*kinetic = series(h, "kinetic_energy"), *elastic = series(h, "elastic_energy"),
        *load = series(h, "load_potential");
  const auto pushed = [&](const char* axis) {
    const std::vector<double>* impulse = series(h, std::string("contact_impulse.") + axis);
    return impulse && impulse->back() != 0;
  };
  const bool landed = pushed("x") || pushed("y") || pushed("z");  // and lost energy: PlaneContact
  if (motion.damping == 0 && motion.viscosity == 0 && !landed && elastic && first < h.time.size()) {
    const auto total = [&](std::size_t i) { return (*kinetic)[i] + (*elastic)[i] + (*load)[i]; };
    double drift = 0, largest = 0;
    for (std::size_t i = first; i < h.time.size(); ++i) {
      drift = std::max(drift, std::abs(total(i) - total(first)));
      largest = std::max(largest, (*kinetic)[i]);
    }
    if (largest > 0) h.measured["energy_drift"] = drift / largest;
  }
  const double scale = std::sqrt(2 * masses.sum() * *std::max_element(kinetic->begin(), kinetic->end()));
  const bool flies = std::none_of(last.fixed.begin(), last.fixed.end(), [](bool f) { return f; });
  if (flies && !network.cells.empty())
    h.measured["inertia_excess"] = inertia_excess(network, masses, motion.mass_consistency);
  if (flies && !motion.plane && last.external.isZero(0) && motion.damping == 0) {
    double drift = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<double>& spin = *series(h, fmt::format("angular_momentum.{}", "xyz"[axis]));
      for (const double value : spin) drift = std::max(drift, std::abs(value - spin.front()));
    }
    if (scale > 0) h.measured["angular_momentum_drift"] = drift / (scale * body_size / 2);
  }
  double drift = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double>& p = *series(h, fmt::format("linear_momentum.{}", "xyz"[axis]));
    bool free = last.external.col(axis).isZero(0) &&
                !(motion.plane && (motion.plane->friction > 0 || motion.plane->normal[axis] != 0));
    for (std::size_t i = axis; i < last.fixed.size(); i += 3) free = free && !last.fixed[i];
    if (free && motion.damping == 0 && first < h.time.size())
      for (std::size_t i = first; i < h.time.size(); ++i) drift = std::max(drift, std::abs(p[i] - p[first]));
  }
  if (drift >= 0 && scale > 0) h.measured["momentum_drift"] = drift / scale;
}

}  // namespace

std::string liveliest(const HistoryRecord& h, const std::string& probe) {
  std::string best;
  double most = -1;
  for (const char axis : {'x', 'y', 'z'}) {
    const std::string name = fmt::format("displacement.{}.{}", probe, axis);
    const auto [low, high] = std::minmax_element(series(h, name)->begin(), series(h, name)->end());
    if (*high - *low > most) {
      most = *high - *low;
      best = name;
    }
  }
  return best;
}

std::map<std::string, double> measured_in_time(const MotionChoice& motion, const HistoryRecord& h) {
  const std::vector<double>& u = *series(h, h.probe);
  const double settled = motion.course.settled();
  const auto first =
      std::isfinite(settled) ? std::lower_bound(h.time.begin(), h.time.end(), settled) - h.time.begin() : 0;
  std::map<std::string, double> out;
  if (const auto swings = swings_of({h.time.begin() + first, h.time.end()}, {u.begin() + first, u.end()})) {
    out["period"] = swings->period;
    out["amplitude"] = swings->amplitude;
    const bool damped = motion.damping > 0 || motion.viscosity > 0;
    if (const auto mode = damped ? damped_swings_of(h.time, u, *swings) : std::nullopt) {
      out["period"] = mode->period;
      out["damping_ratio"] = mode->damping_ratio;
    }
  }
  if (motion.course.pulse > 0)
    if (const auto arrival = arrival_of(h.time, u)) out["arrival"] = *arrival;
  return out;
}

namespace {

/// That of the whole body, about its centre of mass.
NodalVectors rigid_velocity(const MotionChoice& motion, const Network& network, const Eigen::VectorXd& mass) {
  const Vec3 centre = network.X.transpose() * mass / mass.sum();
  NodalVectors v(network.X.rows(), 3);
  for (Eigen::Index n = 0; n < v.rows(); ++n)
    v.row(n) = (motion.velocity + motion.spin.cross(Vec3(network.X.row(n).transpose()) - centre)).transpose();
  return v;
}

}  // namespace

Equilibrium run_motion(const PreparedCase& prepared, const Lattice& lattice, const EmbeddedModel& built,
                       const IsotropicMaterial& material, const LoadPath& path, MotionRecord& record) {
  const MotionChoice& motion = *prepared.experiment.dynamics;
  const Steps steps = steps_of(motion, built.model, material);
  record.history.time_step = steps.size;
  DynamicsOptions options;
  options.viscosity = Viscosity::of(built.model, material, motion.viscosity);
  const Eigen::VectorXd mass = masses(built.model.network, material.density);
  std::optional<PlaneContact> contact;
  if (motion.plane)
    contact.emplace(*motion.plane, mass, std::max(motion.duration / motion.samples, 5 * steps.size),
                    built.embedding.surface);
  options.contact = contact ? &*contact : nullptr;
  options.integrator = steps.integrator;
  options.time_step = steps.size;
  options.damping = motion.damping;
  options.mass_consistency = motion.mass_consistency;
  Recorder recorder(prepared, lattice, built, material, steps, options, record);
  options.course = motion.course;
  options.duration = motion.duration;
  options.stride = steps.stride;
  options.after_step = [&](double time, const NodalVectors& x, const NodalVectors& v, const BoundaryConditions& bc) {
    recorder(time, x, v, bc);
    progress::detail(fmt::format("{:.3g} of {:.3g} s", time, motion.duration));
  };
  options.velocity = rigid_velocity(motion, built.model.network, mass);
  LoadPath in_time = path;
  if (motion.released) {
    const Equilibrium start = solve_finite(built.model, path);
    if (!start.ok) return start;
    options.start = built.model.network.X + start.displacement;
    in_time = [&](double factor) {
      BoundaryConditions bc = path(1.0);
      bc.external *= 1 - factor;
      return bc;
    };
  }
  Equilibrium state = run_dynamics(built.model, material.density, in_time, options).state;
  record.history.integrator = name_of(steps.integrator);
  measure(prepared.experiment, motion, built.model.network, mass, prepared.body.size.norm(), in_time(1.0),
          record.history);
  if (const auto bounce = contact ? contact->bounce() : std::nullopt) {
    record.history.measured["contact_time"] = bounce->end - bounce->begin;
    record.history.measured["restitution"] = -bounce->velocity_after / bounce->velocity_before;
  }
  return state;
}

}  // namespace springproof
