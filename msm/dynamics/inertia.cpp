#include "msm/dynamics/inertia.h"

#include <cmath>

namespace springproof {
namespace {

/// Calls act(corner, axis, mass) for each anchor's support mass; nothing of large steps.
template <class Act>
void for_each_support_mass(const Network& network, const MotionOptions& options, const Act& act) {
  if (options.integrator != Integrator::explicit_euler) return;
  const double dt = options.time_step.value();
  const double factor = MassAverage::largest_gain(options.mass_consistency) * dt * dt / 4;
  for (const Anchor& a : network.anchors) {
    const double k = a.stiffness.cwiseAbs().rowwise().sum().maxCoeff();
    double sum = 0;
    for (const double w : a.weights) sum += std::abs(w);
    for (int n = 0; n < 8; ++n)
      for (int axis = 0; axis < 3; ++axis)
        if (a.acts(axis)) act(a, n, axis, factor * k * std::abs(a.weights[n]) * sum);
  }
}

}  // namespace

NodalVectors support_masses(const Network& network, const MotionOptions& options) {
  NodalVectors mass = NodalVectors::Zero(network.nodes(), 3);
  for_each_support_mass(network, options,
                        [&](const Anchor& a, int n, int axis, double m) { mass(a.corners[n], axis) += m; });
  hand_back(network.cells.carried, mass);
  return mass;
}

NodalVectors inverse_inertia(const Network& network, double density, const MotionOptions& options) {
  NodalVectors inertia = support_masses(network, options);
  inertia.colwise() += masses(network, density);
  return (inertia.array() > 0).select(inertia.array().inverse(), 0.0).matrix();
}

MassAverage mass_average(const Network& network, double density, const MotionOptions& options) {
  return {network, options.mass_consistency,
          (masses(network, density) + support_masses(network, options).col(0)) / density};
}

SupportInertia::SupportInertia(const Network& network, const MotionOptions& options, const NodalVectors& start)
    : network_(network), dt_(options.time_step.value()), damping_(options.damping), here_(start), before_(start) {
  for_each_support_mass(network, options, [&](const Anchor& a, int n, int axis, double m) {
    shares_.push_back({a.corners[n], a.node, axis, m});
  });
}

void SupportInertia::add(BoundaryConditions& conditions) {
  if (!acts()) return;
  const NodalVectors& next = conditions.prescribed;
  const NodalVectors speed = (next - here_) / dt_, acceleration = (speed - (here_ - before_) / dt_) / dt_;
  NodalVectors force = NodalVectors::Zero(network_.nodes(), 3);
  for (const Share& s : shares_)
    force(s.corner, s.axis) += s.mass * (acceleration(s.node, s.axis) + damping_ * speed(s.node, s.axis));
  hand_back(network_.cells.carried, force);
  conditions.external += force;
  before_ = std::move(here_);
  here_ = next;
}

}  // namespace springproof
