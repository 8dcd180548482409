#include "msm/dynamics/plain_motion.h"

#include <cmath>

#include "msm/dynamics/inertia.h"

namespace springproof {

PlainMotion::PlainMotion(const MassSpringModel& model, double density, const MotionOptions& options)
    : MotionOfNodes(model, options),
      dispersion_(options.lagged ? dispersion_of(model) : nullptr),
      inverse_inertia_(inverse_inertia(model.network, density, options)),
      dt_(options.time_step.value()),
      damping_(options.damping),
      viscosity_(options.viscosity),
      energies_wanted_(options.branch_energies),
      average_(mass_average(model.network, density, options)),
      of_supports_(v_) {}

NodalVectors PlainMotion::relaxing_forces() const {
  if (!overstrains_.acts()) return {};
  NodalVectors f = NodalVectors::Zero(x_.rows(), 3);
  overstrains_.add_forces(x_, dt_, f);
  return f;
}

/// At the positions, one step after those that the branches were advanced to.
std::optional<BranchEnergies> PlainMotion::branch_energies() const {
  if (!energies_wanted_ || !overstrains_.acts()) return {};
  Overstrains now = overstrains_;
  now.advance(x_, dt_);
  return BranchEnergies{now.energy(), now.dissipated()};
}

ForceNorms PlainMotion::advance(long steps) {
  ForceNorms norms;
  for (; steps > 0; --steps) norms = step();
  return norms;
}

ForceNorms PlainMotion::step() {
  NodalVectors f = forces_at_x();
  if (viscosity_.acts()) viscosity_.add_forces(model_.network, x_, moving(), f);
  if (overstrains_.acts()) {
    overstrains_.add_forces(x_, dt_, f);
    overstrains_.advance(x_, dt_);
  }
  double unbalanced = 0, support = 0;
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const double force = f.data()[i] + conditions_.external.data()[i];
    (conditions_.fixed[i] ? support : unbalanced) += force * force;
    double& speed = v_.data()[i];
    speed = conditions_.fixed[i] ? 0 : (speed + dt_ * force * inverse_inertia_.data()[i]) / (1 + dt_ * damping_);
  }
  if (viscosity_.acts() || average_.acts())
    for (Eigen::Index i = 0; i < x_.size(); ++i)
      if (conditions_.fixed[i])
        of_supports_.data()[i] = (model_.network.X.data()[i] + conditions_.prescribed.data()[i] - x_.data()[i]) / dt_;
  carry(model_.network.cells.carried, of_supports_);
  const NodalVectors averaged = average_.acts() ? moving() : NodalVectors();
  const NodalVectors& v = average_.acts() ? averaged : v_;
  for (Eigen::Index i = 0; i < x_.size(); ++i)
    if (!conditions_.fixed[i]) x_.data()[i] += dt_ * v.data()[i];
  move_supports();
  carry(model_.network.cells.carried, x_);
  carry(model_.network.cells.carried, v_);
  return {std::sqrt(unbalanced), std::sqrt(support)};
}

/// Velocities of the nodes, supports included.
NodalVectors PlainMotion::moving() const { return average_.velocities(v_ + of_supports_, conditions_.fixed); }

/// Internal forces at x_; lagged: with the J of the previous step.
NodalVectors PlainMotion::forces_at_x() {
  if (!dispersion_) return forces(model_, x_);
  NodalVectors f = NodalVectors::Zero(x_.rows(), 3);
  const auto add = [&]<class Law>(const Law& law) {
    if constexpr (!std::is_same_v<Law, MomentumDispersion>) law.add_forces(model_.network, x_, f);
  };
  for (const ForceLaw& law : model_.laws) std::visit(add, law);
  const Eigen::VectorXd J = dispersion_->inflow(model_.network, x_);
  dispersion_->add_forces(model_.network, x_, J_.size() > 0 ? J_ : J, f);
  J_ = J;
  return f;
}

}  // namespace springproof
