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

/// What moves the nodes: the plain loops, or a kernel.
class Motion {
 public:
  Motion(const MassSpringModel& model, double density, const DynamicsOptions& options)
      : model_(model), x_(model.network.X), v_(NodalVectors::Zero(x_.rows(), 3)), internal_(model, options.lagged),
        inverse_mass_(masses(model.network, density).cwiseInverse()) {
    if (!options.lagged && LatticeMotion::suits(model)) {
      LatticeMotionOptions kernel;
      kernel.precision = options.precision;
      kernel.threads = options.threads;
      lattice_.emplace(model, density, kernel);
    }
  }

  void set_conditions(const BoundaryConditions& bc) {
    bc_ = bc;
    if (lattice_) lattice_->set_conditions(bc);
  }

  void move_supports() {
    if (lattice_) return lattice_->move_supports();
    for (Eigen::Index i = 0; i < x_.size(); ++i)
      if (bc_.fixed[i]) x_.data()[i] = model_.network.X.data()[i] + bc_.prescribed.data()[i];
  }

  ForceNorms advance(long steps, double dt, double damping) {
    if (lattice_) return lattice_->advance(steps, dt, damping);
    ForceNorms norms;
    for (; steps > 0; --steps) norms = plain_step(dt, damping);
    return norms;
  }

  NodalVectors positions() const { return lattice_ ? lattice_->positions() : x_; }
  NodalVectors velocities() const { return lattice_ ? lattice_->velocities() : v_; }
  const Eigen::VectorXd& inverse_mass() const { return inverse_mass_; }
  const BoundaryConditions& conditions() const { return bc_; }
  std::string description() const { return lattice_ ? lattice_->description() : "plain loops"; }

 private:
  ForceNorms plain_step(double dt, double damping) {
    const NodalVectors f = internal_.at(x_);
    double unbalanced = 0, support = 0;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      const double force = f.data()[i] + bc_.external.data()[i];
      if (bc_.fixed[i]) {
        support += force * force;
        continue;
      }
      unbalanced += force * force;
      double& speed = v_.data()[i];
      speed = (speed + dt * force * inverse_mass_[i / 3]) / (1 + dt * damping);
      x_.data()[i] += dt * speed;
    }
    move_supports();
    return {std::sqrt(unbalanced), std::sqrt(support)};
  }

  const MassSpringModel& model_;
  NodalVectors x_, v_;
  Forces internal_;
  Eigen::VectorXd inverse_mass_;
  BoundaryConditions bc_;
  std::optional<LatticeMotion> lattice_;
};

constexpr long steps_between_looks = 10;  // at whether the nodes are at rest, or lost

}  // namespace

double lagged_damping(const MassSpringModel& model, double density, double time_step) {
  return time_step * dispersion_frequency_squared(model, density);
}

DynamicsResult run_dynamics(const MassSpringModel& model, double density, const LoadPath& load_path,
                            const DynamicsOptions& options) {
  const double start = cpu_seconds();
  DynamicsResult result;
  const double dt = result.time_step = checked_time_step(model, density, options);
  const NodalVectors& X = model.network.X;
  Motion motion(model, density, options);
  bool ramping = options.ramp > 0;
  motion.set_conditions(load_path(ramping ? 0.0 : 1.0));
  motion.move_supports();
  const long last = static_cast<long>(std::ceil(options.duration / dt));
  Equilibrium& state = result.state;
  bool at_rest = false;
  while (result.steps < last && !at_rest) {
    result.time = result.steps * dt;
    if (ramping) {
      const double factor = std::min(1.0, result.time / options.ramp);
      motion.set_conditions(load_path(factor));
      ramping = factor < 1;
    }
    const long steps = ramping || options.after_step ? 1 : std::min(steps_between_looks, last - result.steps);
    const ForceNorms norms = motion.advance(steps, dt, options.damping);
    result.steps += steps;
    if (options.after_step) options.after_step(result.steps * dt, motion.positions(), motion.velocities());
    const double scale = std::max(norms.support, motion.conditions().external.norm());
    state.residual = scale > 0 ? norms.unbalanced / scale : 0;
    if (!std::isfinite(state.residual)) {
      state.message = fmt::format("the motion diverged at t = {:.4g} s", result.steps * dt);
      return result;
    }
    at_rest = !ramping && options.rest_tolerance > 0 && state.residual < options.rest_tolerance &&
              motion.velocities().norm() * options.damping * dt < options.rest_tolerance * (motion.positions() - X).norm();
  }
  const NodalVectors x = motion.positions(), v = motion.velocities();
  const BoundaryConditions& bc = motion.conditions();
  result.time = result.steps * dt;
  result.kinetic_energy = 0.5 * (v.rowwise().squaredNorm().array() / motion.inverse_mass().array()).sum();
  state.ok = options.rest_tolerance == 0 || at_rest;
  if (!state.ok)
    state.message = fmt::format("not at rest after {:.4g} s: unbalanced force {:.2e} of the supports'", result.time,
                                state.residual);
  state.displacement = x - X;
  state.support = -forces(model, x) - bc.external;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (!bc.fixed[i]) state.support.data()[i] = 0;
    state.unknowns += !bc.fixed[i];
  }
  state.solver = fmt::format("semi-implicit Euler, {} steps of {:.3g} s, {}", result.steps, dt, motion.description());
  state.iterations = static_cast<int>(result.steps);
  state.seconds = cpu_seconds() - start;
  state.memory_MiB = peak_memory_MiB();
  return result;
}

}  // namespace springproof
