#include "comparisons/bench/relaxation.h"

#include <algorithm>
#include <cmath>

#include "comparisons/bench/bodies.h"
#include "msm/dynamics/dynamics.h"
#include "problem/system/run_cost.h"

namespace springproof::bench {
namespace {

/// Smallest squared frequency [1/s^2], by inverse iteration.
double lowest_frequency_squared(const MassSpringModel& model, BoundaryConditions conditions) {
  const Eigen::VectorXd mass = masses(model.network, density);
  NodalVectors u = solve_linear(model, conditions, {.tolerance = 1e-6}).displacement;
  double lowest = 0;
  for (int i = 0; i < 4; ++i) {
    const NodalVectors load = mass.asDiagonal() * (u / u.norm());
    conditions.external = load;
    u = solve_linear(model, conditions, {.tolerance = 1e-6}).displacement;
    lowest = u.cwiseProduct(load).sum() / (mass.asDiagonal() * u).cwiseProduct(u).sum();
  }
  return lowest;
}

}  // namespace

Relaxation relax(const MassSpringModel& model, const BoundaryConditions& conditions, double tolerance, double factor) {
  Relaxation result;
  DynamicsOptions options;
  options.damping = factor * 2 * std::sqrt(lowest_frequency_squared(model, conditions));
  options.rest_tolerance = tolerance;
  options.duration = 200 * factor / options.damping * std::max(1.0, factor);
  const double start = cpu_seconds();
  const DynamicsResult motion = run_dynamics(
      model, density, [&](double) { return conditions; }, options);
  result.seconds = cpu_seconds() - start;
  result.steps = motion.steps;
  result.at_rest = motion.state.ok;
  result.message = motion.state.message;
  return result;
}

}  // namespace springproof::bench
