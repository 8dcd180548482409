#include "msm/dynamics/dynamics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "msm/dynamics/list_motion.h"
#include "msm/dynamics/plain_motion.h"
#include "msm/dynamics/time_step.h"
#include "msm/kernels/cell_forces.h"
#include "msm/kernels/list_forces.h"
#include "problem/system/run_cost.h"

namespace springproof {
namespace {

constexpr double implicit_ratio = 10;  // default step of implicit methods to the explicit bound

void check_mass(const MassSpringModel& model, const DynamicsOptions& options) {
  const double theta = options.mass_consistency;
  if (!(theta >= 0 && theta <= 1))
    throw InputError(fmt::format("mass_consistency: {:g} is no share of consistent mass (allowed: 0 to 1)", theta));
  if (theta == 0) return;
  if (options.integrator != Integrator::explicit_euler)
    throw InputError("mass_consistency: large steps have lumped mass (allowed beside it: integrator = \"explicit\")");
  if (options.contact)
    throw InputError("mass_consistency: impulses of a plane need lumped mass (allowed beside it: no plane)");
  if (options.lagged) throw InputError("mass_consistency: lagged dispersion needs lumped mass");
  if (const std::string why = MassAverage::lacks(model.network); !why.empty())
    throw InputError("mass_consistency: a share of consistent mass does not suit this model: " + why);
}

}  // namespace

double checked_time_step(const MassSpringModel& model, double density, const DynamicsOptions& options) {
  check_mass(model, options);
  const double safe = safe_time_step(model, density, options.lagged, options.mass_consistency),
               bound = viscous_time_step(model, density, options.viscosity, safe, options.mass_consistency);
  const bool implicit = options.integrator != Integrator::explicit_euler;
  const double dt = options.time_step.value_or(implicit ? implicit_ratio * safe : 0.95 * bound);
  if (!(dt > 0) || (dt > bound && !implicit))
    throw InputError(
        fmt::format("time_step_s: {:.6g} s is not safe for this model (allowed: 0 < time_step_s <= {:.6g} s, the bound "
                    "of its springs and cells)",
                    dt, bound));
  if (options.integrator == Integrator::energy_momentum)
    if (const std::string why = EnergyMomentum::lacks(model); !why.empty())
      throw InputError("integrator: energy_momentum does not suit this model: " + why);
  if (const MomentumDispersion* dispersion = dispersion_of(model);
      options.lagged && dispersion && dispersion->form == Dispersion::finite_strain)
    throw InputError("lagged dispersion is not of finite strain (allowed: dispersion = \"symmetric\")");
  if (implicit && options.lagged) throw InputError("integrator: lagged dispersion needs the explicit one");
  if (implicit && options.contact && options.contact->plane().friction > 0)
    throw InputError("integrator: large steps have a plane without friction (allowed: friction = 0, or explicit)");
  if (implicit && options.contact && (!options.contact->of_nodes() || !model.network.carried.empty()))
    throw InputError(
        "integrator: large steps have contact of nodes, not of the surface of cut cells (allowed: cut = false, or "
        "explicit)");
  if (const std::string why = options.viscosity.acts() ? Viscosity::lacks(model) : ""; !why.empty())
    throw InputError("viscosity does not suit this model: " + why);
  if (!(options.damping >= 0)) throw InputError("damping_1_s: must be >= 0");
  const double least = options.lagged ? lagged_damping(model, density, dt) : 0;
  if (least > 0 && !(options.damping > least))
    throw InputError(
        fmt::format("damping_1_s: {:.6g} 1/s lets lagged dispersion grow (allowed: > {:.6g} 1/s at a step of {:.6g} s)",
                    options.damping, least, dt));
  return dt;
}

namespace {

/// Networks of springs, with or without momentum dispersion, and bodies of cut cells.
template <class Real>
class MotionOfList : public Motion {
 public:
  MotionOfList(std::unique_ptr<BlockForces<Real>> forces, const Network& network, const Eigen::VectorXd& inverse_mass,
               const ListMotionOptions& options, const MassAverage& average)
      : motion_(std::move(forces), network.X, inverse_mass, options, average), carried_(network.carried) {}

  void set_conditions(const BoundaryConditions& conditions) override { motion_.load(conditions); }
  void move_supports() override { motion_.place_prescribed(); }
  void set_state(const NodalVectors& x, const NodalVectors& v) override { motion_.set_state(x, v); }
  ForceNorms advance(long steps) override { return motion_.advance(steps); }
  NodalVectors positions() const override { return with_carried(motion_.positions()); }
  NodalVectors velocities() const override { return with_carried(motion_.velocities()); }
  std::string description() const override {
    return fmt::format("{}, {}, {}, {}", motion_.kernel(), sizeof(Real) == 4 ? "FP32" : "FP64",
                       name_of(instruction_set()),
                       motion_.threads() == 1 ? "1 thread" : fmt::format("{} threads", motion_.threads()));
  }

 private:
  NodalVectors with_carried(NodalVectors of_nodes) const {
    carry(carried_, of_nodes);
    return of_nodes;
  }

  ListMotion<Real> motion_;
  std::vector<CarriedPoint> carried_;
};

/// Lattices that have a kernel.
class MotionOfLattice : public Motion {
 public:
  MotionOfLattice(const MassSpringModel& model, double density, double time_step, const DynamicsOptions& options)
      : motion_(model, density,
                on_chosen_device(model, {.precision = options.precision,
                                         .threads = options.threads,
                                         .viscosity = options.viscosity,
                                         .mass_consistency = options.mass_consistency})),
        dt_(time_step),
        damping_(options.damping) {}

  void set_conditions(const BoundaryConditions& conditions) override { motion_.set_conditions(conditions); }
  void move_supports() override { motion_.move_supports(); }
  void set_state(const NodalVectors& x, const NodalVectors& v) override { motion_.set_state(x, v); }
  ForceNorms advance(long steps) override { return motion_.advance(steps, dt_, damping_); }
  NodalVectors positions() const override { return motion_.positions(); }
  NodalVectors velocities() const override { return motion_.velocities(); }
  std::string description() const override { return motion_.description(); }

 private:
  LatticeMotion motion_;
  double dt_, damping_;
};

class MotionInLargeSteps : public Motion {
 public:
  MotionInLargeSteps(const MassSpringModel& model, double density, const ImplicitOptions& options)
      : motion_(model, density, options) {}

  void set_conditions(const BoundaryConditions& conditions) override { motion_.set_conditions(conditions); }
  void move_supports() override { motion_.move_supports(); }
  void set_state(const NodalVectors& x, const NodalVectors& v) override { motion_.set_state(x, v); }
  ForceNorms advance(long steps) override { return motion_.advance(steps); }
  NodalVectors positions() const override { return motion_.positions(); }
  NodalVectors velocities() const override { return motion_.velocities(); }
  std::string description() const override { return motion_.description(); }
  std::string failure() const override { return motion_.failure(); }

 private:
  ImplicitMotion motion_;
};

/// Forces of the kernels for lists of springs and of cells; nullptr: these lack the model or an option.
template <class Real>
std::unique_ptr<BlockForces<Real>> block_forces(const MassSpringModel& model, const DynamicsOptions& options) {
  if (options.mass_consistency > 0 && options.viscosity.acts()) return nullptr;
  const AveragedSprings& dashpots = options.viscosity.cells();
  if (CellForces<Real>::covers(model) && !options.viscosity.along_springs() && dashpots.shift == 0)
    return std::make_unique<CellForces<Real>>(model, instruction_set(), dashpots, options.viscosity.time());
  if (ListForces<Real>::covers(model) && !options.viscosity.acts()) return std::make_unique<ListForces<Real>>(model);
  return nullptr;
}

/// By these kernels, or nullptr.
template <class Real>
std::unique_ptr<Motion> motion_by_lists(const MassSpringModel& model, const Eigen::VectorXd& inverse_mass, double dt,
                                        const DynamicsOptions& options) {
  std::unique_ptr<BlockForces<Real>> forces = block_forces<Real>(model, options);
  if (!forces) return nullptr;
  const ListMotionOptions of_list{dt, options.damping, options.lagged, options.threads};
  return std::make_unique<MotionOfList<Real>>(std::move(forces), model.network, inverse_mass, of_list,
                                              MassAverage(model.network, options.mass_consistency));
}

}  // namespace

std::unique_ptr<Motion> make_motion(const MassSpringModel& model, double density, double dt,
                                    const DynamicsOptions& options) {
  if (options.integrator != Integrator::explicit_euler)
    return std::make_unique<MotionInLargeSteps>(model, density,
                                                ImplicitOptions{.integrator = options.integrator,
                                                                .time_step = dt,
                                                                .damping = options.damping,
                                                                .viscosity = options.viscosity,
                                                                .contact = options.contact});
  if (!options.lagged && LatticeMotion::suits(model, options.viscosity, options.mass_consistency))
    return std::make_unique<MotionOfLattice>(model, density, dt, options);
  const Eigen::VectorXd inverse_mass = inverse_masses(model.network, density);
  std::unique_ptr<Motion> motion = options.precision == Precision::float32
                                       ? motion_by_lists<float>(model, inverse_mass, dt, options)
                                       : motion_by_lists<double>(model, inverse_mass, dt, options);
  if (!motion) motion = std::make_unique<PlainMotion>(model, inverse_mass, dt, options);
  return motion;
}

const char* name_of(Integrator integrator) {
  switch (integrator) {
    case Integrator::energy_momentum:
      return "energy-momentum";
    case Integrator::implicit_euler:
      return "implicit Euler";
    default:
      return "semi-implicit Euler";
  }
}

namespace {

constexpr long steps_between_looks = 10;  // looks: checks for rest and divergence

}  // namespace

double lagged_damping(const MassSpringModel& model, double density, double time_step) {
  return time_step * dispersion_frequency_squared(model, density);
}

NodalVectors velocity_before(const MassSpringModel& model, double density, const NodalVectors& x,
                             const BoundaryConditions& bc, double dt, const DynamicsOptions& options) {
  NodalVectors v = options.velocity;
  if (v.size() == 0) return NodalVectors::Zero(x.rows(), 3);
  const Eigen::VectorXd per_mass = inverse_masses(model.network, density);
  NodalVectors there = x;  // where supports are from the start
  for (Eigen::Index i = 0; i < v.size(); ++i)
    if (bc.fixed[i]) there.data()[i] = model.network.X.data()[i] + bc.prescribed.data()[i];
  NodalVectors f = forces(model, there) + bc.external;
  if (options.viscosity.acts()) options.viscosity.add_forces(model.network, there, v, f);
  const bool explicit_steps = options.integrator == Integrator::explicit_euler;
  for (Eigen::Index i = 0; i < v.size(); ++i)
    if (bc.fixed[i]) v.data()[i] = 0;
  v = MassAverage(model.network, options.mass_consistency).momenta(v, bc.fixed);
  for (Eigen::Index i = 0; i < v.size(); ++i)
    if (!bc.fixed[i] && explicit_steps)
      v.data()[i] -= dt / 2 * (f.data()[i] * per_mass[i / 3] - options.damping * v.data()[i]);
  return v;
}

namespace {

/// Contact with the plane at the end of an explicit step.
void touch(Motion& motion, PlaneContact& contact, double dt, double damping, const BoundaryConditions& bc) {
  NodalVectors x = motion.positions(), v = motion.velocities();
  if (contact.correct(dt, damping, bc.fixed, x, v)) motion.set_state(x, v);
}

}  // namespace

DynamicsResult run_dynamics(const MassSpringModel& model, double density, const LoadPath& load_path,
                            const DynamicsOptions& options) {
  const double start = cpu_seconds();
  DynamicsResult result;
  const double dt = result.time_step = checked_time_step(model, density, options);
  const NodalVectors& X = model.network.X;
  const std::unique_ptr<Motion> motion = make_motion(model, density, dt, options);
  bool changing = options.course.settled() > 0;
  BoundaryConditions bc = load_path(options.course.factor(0));
  motion->set_conditions(bc);
  if (options.start.size() > 0 || options.velocity.size() > 0) {
    const NodalVectors x = options.start.size() > 0 ? options.start : X;
    motion->set_state(x, velocity_before(model, density, x, bc, dt, options));
  }
  motion->move_supports();
  if (options.contact) options.contact->observe(0, motion->velocities());
  // The explicit method takes loads and supports of the beginning of a step, implicit ones those of its end.
  const long ahead = options.integrator == Integrator::explicit_euler ? 0 : 1;
  const long last = static_cast<long>(std::ceil(options.duration / dt));
  Equilibrium& state = result.state;
  bool at_rest = false;
  while (result.steps < last && !at_rest) {
    result.time = result.steps * dt;
    if (changing) {
      const double time = static_cast<double>(result.steps + ahead) * dt;
      bc = load_path(options.course.factor(time));
      motion->set_conditions(bc);
      changing = time < options.course.settled();
    }
    const long to_stop = options.after_step ? options.stride - result.steps % options.stride : steps_between_looks;
    const long steps = changing || options.contact ? 1 : std::min({steps_between_looks, to_stop, last - result.steps});
    const ForceNorms norms = motion->advance(steps);
    if (const std::string why = motion->failure(); !why.empty()) {
      state.message =
          fmt::format("between t = {:.4g} and {:.4g} s {}", result.steps * dt, (result.steps + steps) * dt, why);
      return result;
    }
    result.steps += steps;
    if (options.contact && ahead == 0) touch(*motion, *options.contact, dt, options.damping, bc);
    if (options.contact) options.contact->observe(result.steps * dt, motion->velocities());
    if (options.after_step && (result.steps % options.stride == 0 || result.steps == last))
      options.after_step(result.steps * dt, motion->positions(), motion->velocities(), bc);
    const double scale = std::max(norms.support, bc.external.norm());
    state.residual = scale > 0 ? norms.unbalanced / scale : 0;
    if (!std::isfinite(norms.unbalanced) || !std::isfinite(norms.support)) {
      state.message = fmt::format("the motion diverged at t = {:.4g} s", result.steps * dt);
      return result;
    }
    at_rest =
        !changing && options.rest_tolerance > 0 && state.residual < options.rest_tolerance &&
        motion->velocities().norm() * options.damping * dt < options.rest_tolerance * (motion->positions() - X).norm();
  }
  const NodalVectors x = motion->positions(), s = motion->velocities();
  const NodalVectors v = MassAverage(model.network, options.mass_consistency).velocities(s);
  result.time = result.steps * dt;
  result.kinetic_energy =
      0.5 * (v.cwiseProduct(s).rowwise().sum().array() * masses(model.network, density).array()).sum();
  state.ok = options.rest_tolerance == 0 || at_rest;
  if (!state.ok)
    state.message = fmt::format("not at rest after {:.4g} s: unbalanced force {:.2e} of the supports'", result.time,
                                state.residual);
  state.displacement = x - X;
  state.support = support_forces(model, x, bc);
  state.unknowns = std::count(bc.fixed.begin(), bc.fixed.end(), false);
  state.solver =
      fmt::format("{}, {} steps of {:.3g} s, {}", name_of(options.integrator), result.steps, dt, motion->description());
  state.iterations = static_cast<int>(result.steps);
  state.seconds = cpu_seconds() - start;
  state.memory_MiB = peak_memory_MiB();
  return result;
}

}  // namespace springproof
