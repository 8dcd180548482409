#include "msm/solve/dynamics.h"

#include <fmt/format.h>

#include <cmath>

#include "msm/solve/cell_stiffness.h"
#include "msm/solve/cost.h"

namespace springproof {
namespace {

double checked_time_step(const MassSpringModel& model, double density, const DynamicsOptions& options) {
  const double bound = safe_time_step(model, density);
  const double dt = options.time_step.value_or(0.95 * bound);
  if (!(dt > 0) || dt > bound)
    throw InputError(fmt::format(
        "time_step_s: {:.6g} s is not safe for this model (allowed: 0 < time_step_s <= {:.6g} s, the bound of one cell)",
        dt, bound));
  if (!(options.damping >= 0)) throw InputError("damping_1_s: must be >= 0");
  return dt;
}

}  // namespace

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
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (bc.fixed[i]) x.data()[i] += bc.prescribed.data()[i];
  for (; result.steps < last; ++result.steps) {
    result.time = result.steps * dt;
    if (ramping) {
      const double factor = std::min(1.0, result.time / options.ramp);
      bc = load_path(factor);
      ramping = factor < 1;
    }
    f = forces(model, x);
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
