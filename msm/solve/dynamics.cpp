#include "msm/solve/dynamics.h"

#include <fmt/format.h>

#include <cmath>

#include "msm/solve/time_step.h"
#include "msm/solve/cost.h"

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

/// Internal forces of a model; lagged: with the J that its nodes had at the step before.
class Forces {
 public:
  Forces(const MassSpringModel& model, bool lagged) : model_(model), dispersion_(lagged ? dispersion_of(model) : nullptr) {}

  NodalVectors at(const NodalVectors& x) {
    if (!dispersion_) return forces(model_, x);
    NodalVectors f = NodalVectors::Zero(x.rows(), 3);
    for (const ForceLaw& law : model_.laws)
      if (!std::holds_alternative<MomentumDispersion>(law)) std::visit([&](const auto& l) { l.add_forces(model_.network, x, f); }, law);
    const Eigen::VectorXd J = dispersion_->inflow(model_.network, x);
    dispersion_->add_forces(model_.network, x, J_.size() > 0 ? J_ : J, f);
    J_ = J;
    return f;
  }

 private:
  const MassSpringModel& model_;
  const MomentumDispersion* dispersion_;  ///< nullptr: nothing lags
  Eigen::VectorXd J_;
};

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
  BoundaryConditions bc = load_path(options.ramp > 0 ? 0.0 : 1.0);
  NodalVectors x = X, v = NodalVectors::Zero(X.rows(), 3), f;
  const long last = static_cast<long>(std::ceil(options.duration / dt));
  Equilibrium& state = result.state;
  bool ramping = options.ramp > 0;
  Forces internal(model, options.lagged);
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (bc.fixed[i]) x.data()[i] += bc.prescribed.data()[i];
  for (; result.steps < last; ++result.steps) {
    result.time = result.steps * dt;
    if (ramping) {
      const double factor = std::min(1.0, result.time / options.ramp);
      bc = load_path(factor);
      ramping = factor < 1;
    }
    f = internal.at(x);
    double unbalanced = 0, support = 0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double force = f.data()[i] + bc.external.data()[i];
      if (bc.fixed[i]) {
        support += force * force;
        x.data()[i] = X.data()[i] + bc.prescribed.data()[i];
        continue;
      }
      unbalanced += force * force;
      double& speed = v.data()[i];
      speed = (speed + dt * force * inverse_mass[i / 3]) / (1 + dt * options.damping);
      x.data()[i] += dt * speed;
    }
    if (options.after_step) options.after_step(result.time + dt, x, v);
    const double scale = std::max(std::sqrt(support), bc.external.norm());
    state.residual = scale > 0 ? std::sqrt(unbalanced) / scale : 0;
    if (!std::isfinite(state.residual)) {
      state.message = fmt::format("the motion diverged at t = {:.4g} s", result.time);
      return result;
    }
    if (!ramping && options.rest_tolerance > 0 && state.residual < options.rest_tolerance &&
        v.norm() * options.damping * dt < options.rest_tolerance * (x - X).norm())
      break;
  }
  result.time = result.steps * dt;
  result.kinetic_energy = 0.5 * (v.rowwise().squaredNorm().array() / inverse_mass.array()).sum();
  state.ok = options.rest_tolerance == 0 || result.steps < last;
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
