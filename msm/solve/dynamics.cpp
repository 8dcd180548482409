#include "msm/solve/dynamics.h"

#include <fmt/format.h>

#include <cmath>

#include "msm/kernels/list_forces.h"
#include "msm/solve/cost.h"
#include "msm/solve/time_step.h"

namespace springproof {
namespace {

double checked_time_step(const MassSpringModel& model, double density, const DynamicsOptions& options) {
  const double bound = safe_time_step(model, density, options.lagged);
  const double dt = options.time_step.value_or(0.95 * bound);
  if (!(dt > 0) || dt > bound)
    throw InputError(fmt::format(
        "time_step_s: {:.6g} s is not safe for this model (allowed: 0 < time_step_s <= {:.6g} s, the bound of its springs and cells)",
        dt, bound));
  if (!(options.damping >= 0)) throw InputError("damping_1_s: must be >= 0");
  const double least = options.lagged ? lagged_damping(model, density, dt) : 0;
  if (least > 0 && !(options.damping > least))
    throw InputError(fmt::format("damping_1_s: {:.6g} 1/s lets lagged dispersion grow (allowed: > {:.6g} 1/s at a step of {:.6g} s)",
                                 options.damping, least, dt));
  return dt;
}

/// Any model in motion, by the plain force loops.  (ListMotion has the same functions.)
class PlainMotion {
 public:
  PlainMotion(const MassSpringModel& model, const Eigen::VectorXd& inverse_mass, double time_step, double damping, bool lagged)
      : model_(model), dispersion_(lagged ? dispersion_of(model) : nullptr), inverse_mass_(inverse_mass), dt_(time_step),
        damping_(damping), x_(model.network.X), v_(NodalVectors::Zero(x_.rows(), 3)) {}

  void load(const BoundaryConditions& conditions) { conditions_ = conditions; }

  void place_prescribed() {
    for (Eigen::Index i = 0; i < x_.size(); ++i)
      if (conditions_.fixed[i]) x_.data()[i] = model_.network.X.data()[i] + conditions_.prescribed.data()[i];
  }

  SquaredForces step() {
    const NodalVectors f = forces_at_x();
    SquaredForces squared;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      const double force = f.data()[i] + conditions_.external.data()[i];
      (conditions_.fixed[i] ? squared.support : squared.unbalanced) += force * force;
      if (conditions_.fixed[i]) continue;
      double& speed = v_.data()[i];
      speed = (speed + dt_ * force * inverse_mass_[i / 3]) / (1 + dt_ * damping_);
      x_.data()[i] += dt_ * speed;
    }
    place_prescribed();
    return squared;
  }

  const NodalVectors& positions() const { return x_; }
  const NodalVectors& velocities() const { return v_; }

 private:
  /// Lagged: with the J that the nodes had at the step before.
  NodalVectors forces_at_x() {
    if (!dispersion_) return forces(model_, x_);
    NodalVectors f = NodalVectors::Zero(x_.rows(), 3);
    for (const ForceLaw& law : model_.laws)
      if (!std::holds_alternative<MomentumDispersion>(law)) std::visit([&](const auto& l) { l.add_forces(model_.network, x_, f); }, law);
    const Eigen::VectorXd J = dispersion_->inflow(model_.network, x_);
    dispersion_->add_forces(model_.network, x_, J_.size() > 0 ? J_ : J, f);
    J_ = J;
    return f;
  }

  const MassSpringModel& model_;
  const MomentumDispersion* dispersion_;  ///< nullptr: nothing lags
  Eigen::VectorXd inverse_mass_, J_;
  double dt_, damping_;
  NodalVectors x_, v_;
  BoundaryConditions conditions_;
};

struct Final {
  NodalVectors x, v;
  BoundaryConditions conditions;
};

/// Runs until the time is over, the model is at rest, or the motion diverged (then with a message).
template <class Motion>
Final run(Motion&& motion, const NodalVectors& X, const LoadPath& load_path, const DynamicsOptions& options, DynamicsResult& result) {
  const double dt = result.time_step;
  const long last = static_cast<long>(std::ceil(options.duration / dt));
  bool ramping = options.ramp > 0;
  Equilibrium& state = result.state;
  BoundaryConditions bc = load_path(ramping ? 0.0 : 1.0);
  double load = bc.external.norm();
  motion.load(bc);
  motion.place_prescribed();
  for (; result.steps < last; ++result.steps) {
    result.time = result.steps * dt;
    if (ramping) {
      const double factor = std::min(1.0, result.time / options.ramp);
      bc = load_path(factor);
      load = bc.external.norm();
      motion.load(bc);
      ramping = factor < 1;
    }
    const SquaredForces squared = motion.step();
    if (options.after_step) options.after_step(result.time + dt, motion.positions(), motion.velocities());
    const double scale = std::max(std::sqrt(squared.support), load);
    state.residual = scale > 0 ? std::sqrt(squared.unbalanced) / scale : 0;
    if (!std::isfinite(state.residual)) {
      state.message = fmt::format("the motion diverged at t = {:.4g} s", result.time);
      break;
    }
    if (!ramping && options.rest_tolerance > 0 && state.residual < options.rest_tolerance &&
        motion.velocities().norm() * options.damping * dt < options.rest_tolerance * (motion.positions() - X).norm())
      break;
  }
  return {motion.positions(), motion.velocities(), std::move(bc)};
}

}  // namespace

double lagged_damping(const MassSpringModel& model, double density, double time_step) {
  return time_step * dispersion_frequency_squared(model, density);
}

DynamicsResult run_dynamics(const MassSpringModel& model, double density, const LoadPath& load_path,
                            const DynamicsOptions& options) {
  const double start = cpu_seconds();
  DynamicsResult result;
  const double dt = result.time_step = checked_time_step(model, density, options);
  const Eigen::VectorXd inverse_mass = masses(model.network, density).cwiseInverse();
  const NodalVectors& X = model.network.X;
  const auto& [x, v, bc] = ListForces<double>::covers(model)
                               ? run(ListMotion<double>(model, inverse_mass, dt, options.damping, options.lagged), X, load_path, options, result)
                               : run(PlainMotion(model, inverse_mass, dt, options.damping, options.lagged), X, load_path, options, result);
  Equilibrium& state = result.state;
  if (!state.message.empty()) return result;
  result.time = result.steps * dt;
  result.kinetic_energy = 0.5 * (v.rowwise().squaredNorm().array() / inverse_mass.array()).sum();
  state.ok = options.rest_tolerance == 0 || result.steps < std::ceil(options.duration / dt);
  if (!state.ok)
    state.message = fmt::format("not at rest after {:.4g} s: unbalanced force {:.2e} of the supports'", result.time,
                                state.residual);
  state.displacement = x - X;
  state.support = -forces(model, x) - bc.external;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (!bc.fixed[i]) state.support.data()[i] = 0;
    state.unknowns += !bc.fixed[i];
  }
  state.solver = fmt::format("semi-implicit Euler, {} steps of {:.3g} s", result.steps, dt);
  state.iterations = static_cast<int>(result.steps);
  state.seconds = cpu_seconds() - start;
  state.memory_MiB = peak_memory_MiB();
  return result;
}

}  // namespace springproof
