#include "msm/dynamics/dynamics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "msm/algebra/fixed.h"
#include "msm/dynamics/implicit_motion.h"
#include "msm/dynamics/inertia.h"
#include "msm/dynamics/lattice_motion.h"
#include "msm/dynamics/list_motion.h"
#include "msm/dynamics/plain_motion.h"
#include "problem/system/run_cost.h"

namespace springproof {

std::unique_ptr<Motion> make_motion(const MassSpringModel& model, double density, const MotionOptions& options) {
  if (options.integrator != Integrator::explicit_euler)
    return std::make_unique<ImplicitMotion>(model, density, options);
  if (LatticeMotion::suits(model, options)) return lattice_motion(model, density, on_chosen_device(model, options));
  if (std::unique_ptr<Motion> by_lists = list_motion(model, density, options)) return by_lists;
  return std::make_unique<PlainMotion>(model, density, options);
}

NodalVectors velocity_before(const MassSpringModel& model, double density, const NodalVectors& x,
                             const BoundaryConditions& bc, const DynamicsOptions& options) {
  NodalVectors v = options.velocity;
  if (v.size() == 0) return NodalVectors::Zero(x.rows(), 3);
  const NodalVectors per_mass = inverse_inertia(model.network, density, options);
  NodalVectors there = x;  // where supports are from the start
  for (Eigen::Index i = 0; i < v.size(); ++i)
    if (bc.fixed[i]) there.data()[i] = model.network.X.data()[i] + bc.prescribed.data()[i];
  NodalVectors f = forces(model, there) + bc.external;
  if (options.viscosity.acts()) options.viscosity.add_forces(model.network, there, v, f);
  const bool explicit_steps = options.integrator == Integrator::explicit_euler;
  const double dt = options.time_step.value();
  clear_fixed(bc.fixed, v);
  v = mass_average(model.network, density, options).momenta(v, bc.fixed);
  for (Eigen::Index i = 0; i < v.size(); ++i)
    if (!bc.fixed[i] && explicit_steps)
      v.data()[i] -= dt / 2 * (f.data()[i] * per_mass.data()[i] - options.damping * v.data()[i]);
  return v;
}

namespace {

constexpr long steps_between_looks = 10;  // looks: checks for rest and divergence

/// A motion under loads that change in time, until its end, rest or failure.
class MotionUnderLoads {
 public:
  /// @param options with a time step
  MotionUnderLoads(const MassSpringModel& model, double density, const LoadPath& load_path,
                   const DynamicsOptions& options)
      : model_(model),
        density_(density),
        load_path_(load_path),
        options_(options),
        dt_(options.time_step.value()),
        motion_(make_motion(model, density, options)),
        changing_(options.course.settled() > 0),
        bc_(load_path(options.course.factor(0))),
        of_supports_(model.network, options, bc_.prescribed) {
    result_.time_step = dt_;
    motion_->set_conditions(bc_);
    if (options.start.size() > 0 || options.velocity.size() > 0) {
      const NodalVectors x = options.start.size() > 0 ? options.start : model.network.X;
      motion_->set_state(x, velocity_before(model, density, x, bc_, options));
      motion_->relax();
    }
    motion_->move_supports();
    if (options.contact) options.contact->observe(0, motion_->velocities());
  }

  DynamicsResult result() {
    const long last = static_cast<long>(std::ceil(options_.duration / dt_));
    while (result_.steps < last && !at_rest_) {
      set_conditions();
      if (!advance(last)) return result_;
    }
    finish();
    return result_;
  }

 private:
  bool is_explicit() const { return options_.integrator == Integrator::explicit_euler; }

  /// Explicit methods take the loads of the beginning of a step, implicit ones those of its end; all take the supports
  /// of its end.
  void set_conditions() {
    result_.time = result_.steps * dt_;
    if (!changing_) return;
    const double end = static_cast<double>(result_.steps + 1) * dt_, time = is_explicit() ? end - dt_ : end;
    BoundaryConditions at_end = load_path_(options_.course.factor(end)), of_step = at_end;
    if (is_explicit()) of_step.external = bc_.external;
    of_supports_.add(of_step);
    motion_->set_conditions(of_step);
    bc_ = std::move(at_end);
    changing_ = time < options_.course.settled() + (of_supports_.acts() ? 2 * dt_ : 0);  // two steps, until they rest
  }

  /// Steps until something looks at them; false: they failed.
  bool advance(long last) {
    const long to_stop = options_.after_step ? options_.stride - result_.steps % options_.stride : steps_between_looks;
    const long steps =
        changing_ || options_.contact ? 1 : std::min({steps_between_looks, to_stop, last - result_.steps});
    const ForceNorms norms = motion_->advance(steps);
    if (const std::string why = motion_->failure(); !why.empty()) {
      result_.state.message =
          fmt::format("between t = {:.4g} and {:.4g} s {}", result_.steps * dt_, (result_.steps + steps) * dt_, why);
      return false;
    }
    result_.steps += steps;
    if (options_.contact) touch();
    if (options_.after_step && (result_.steps % options_.stride == 0 || result_.steps == last))
      options_.after_step({result_.steps * dt_, motion_->positions(), motion_->velocities(), bc_,
                           motion_->relaxing_forces(), motion_->branch_energies()});
    return look(norms);
  }

  /// Contact with the plane at the end of a step.
  void touch() {
    if (is_explicit()) {
      NodalVectors x = motion_->positions(), v = motion_->velocities();
      if (options_.contact->correct(dt_, options_.damping, bc_.fixed, x, v)) motion_->set_state(x, v);
    }
    options_.contact->observe(result_.steps * dt_, motion_->velocities());
  }

  /// Whether the forces are finite, and at rest.
  bool look(const ForceNorms& norms) {
    const double scale = std::max(norms.support, bc_.external.norm());
    result_.state.residual = scale > 0 ? norms.unbalanced / scale : 0;
    if (!std::isfinite(norms.unbalanced) || !std::isfinite(norms.support)) {
      result_.state.message = fmt::format("the motion diverged at t = {:.4g} s", result_.steps * dt_);
      return false;
    }
    at_rest_ = !changing_ && options_.rest_tolerance > 0 && result_.state.residual < options_.rest_tolerance &&
               motion_->velocities().norm() * options_.damping * dt_ <
                   options_.rest_tolerance * (motion_->positions() - model_.network.X).norm();
    return true;
  }

  void finish() {
    const NodalVectors x = motion_->positions(), s = motion_->velocities();
    const NodalVectors v = mass_average(model_.network, density_, options_).velocities(s);
    result_.time = result_.steps * dt_;
    result_.kinetic_energy =
        0.5 * (v.cwiseProduct(s).rowwise().sum().array() * masses(model_.network, density_).array()).sum();
    Equilibrium& state = result_.state;
    state.ok = options_.rest_tolerance == 0 || at_rest_;
    if (!state.ok)
      state.message = fmt::format("not at rest after {:.4g} s: unbalanced force {:.2e} of the supports'", result_.time,
                                  state.residual);
    state.displacement = x - model_.network.X;
    state.support = support_forces(model_, x, bc_);
    const NodalVectors relaxing = motion_->relaxing_forces();
    for (Eigen::Index i = 0; i < relaxing.size(); ++i)
      if (bc_.fixed[i]) state.support.data()[i] -= relaxing.data()[i];
    state.unknowns = std::count(bc_.fixed.begin(), bc_.fixed.end(), false);
    state.solver = fmt::format("{}, {} steps of {:.3g} s, {}", name_of(options_.integrator), result_.steps, dt_,
                               motion_->description());
    state.iterations = static_cast<int>(result_.steps);
  }

  const MassSpringModel& model_;
  double density_;
  const LoadPath& load_path_;
  const DynamicsOptions& options_;
  double dt_;  ///< [s]
  std::unique_ptr<Motion> motion_;
  bool changing_, at_rest_ = false;
  BoundaryConditions bc_;  ///< at the time of the positions
  SupportInertia of_supports_;
  DynamicsResult result_;
};

}  // namespace

DynamicsResult run_dynamics(const MassSpringModel& model, double density, const LoadPath& load_path,
                            const DynamicsOptions& options) {
  const double start = cpu_seconds();
  DynamicsOptions checked = options;
  checked.time_step = checked_time_step(model, density, options);
  DynamicsResult result = MotionUnderLoads(model, density, load_path, checked).result();
  result.state.seconds = cpu_seconds() - start;
  result.state.memory_MiB = peak_memory_MiB();
  return result;
}

}  // namespace springproof
