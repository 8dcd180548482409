// Bodies that fly against a plane.
#pragma once

#include <Eigen/Geometry>

#include "msm/dynamics/dynamics.h"
#include "msm/models.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::test {

/// How a free body without supports flies.
struct FlightPlan {
  Plane plane = {};
  double duration = 0;                ///< [s]
  Vec3 velocity = Vec3::Zero();       ///< [m/s]
  Vec3 acceleration = Vec3::Zero();   ///< of gravity [m/s^2]
  double damping = 0, viscosity = 0;  ///< [1/s], [s]
  PointWeights points = {};           ///< of the body's surface
  DynamicsOptions options = {};       ///< integrator, step
};

/// Where it ends.
struct Flight {
  NodalVectors x, v;
  ContactImpulse impulse;
  std::optional<Bounce> bounce;
  Eigen::VectorXd mass;
  double most_energy = 0;                  ///< at any time, of large steps [J]
  double energy = 0, energy_at_start = 0;  ///< kinetic and elastic, and that of the weight [J]
  double deepest = 0;                      ///< of its points behind the plane, at any time [m]
  double largest_step = 0;                 ///< of a point [m]
  double duration = 0, step = 0;           ///< [s]
  Vec3 spin_at_start = Vec3::Zero();       ///< about the origin [kg m^2/s]
  std::string message;

  Vec3 momentum() const { return v.transpose() * mass; }
  Vec3 spin() const { return spin_of(x, v, mass); }
  static Vec3 spin_of(const NodalVectors& x, const NodalVectors& v, const Eigen::VectorXd& mass) {
    Vec3 sum = Vec3::Zero();
    for (Eigen::Index n = 0; n < x.rows(); ++n)
      sum += mass[n] * Vec3(x.row(n).transpose()).cross(Vec3(v.row(n).transpose()));
    return sum;
  }
};

inline Flight fly(const MassSpringModel& model, double density, const FlightPlan& plan) {
  const Network& network = model.network;
  Flight flight;
  flight.mass = masses(network, density);
  PlaneContact contact(plan.plane, flight.mass, 0.02, plan.points);
  DynamicsOptions options = plan.options;
  options.contact = &contact;
  options.duration = plan.duration;
  options.damping = plan.damping;
  options.velocity = NodalVectors(network.nodes(), 3);
  options.velocity.rowwise() = plan.velocity.transpose();
  const auto energy_of = [&](const NodalVectors& x, const NodalVectors& v) {
    const double weight = -(x.transpose() * flight.mass).dot(plan.acceleration);
    return 0.5 * (v.rowwise().squaredNorm().array() * flight.mass.array()).sum() + energy(model, x) + weight;
  };
  flight.step = checked_time_step(model, density, options);
  options.after_step = [&](const MotionSample& sample) {
    const NodalVectors& x = sample.x;
    const NodalVectors& v = sample.v;
    flight.x = x;
    flight.v = v;
    flight.most_energy = std::max(flight.most_energy, energy_of(x, v));
    flight.largest_step = std::max(flight.largest_step, flight.step * v.rowwise().norm().maxCoeff());
    const NodalVectors at = plan.points.rows() > 0 ? NodalVectors(plan.points * x) : x;
    for (const auto& p : at.rowwise())
      flight.deepest = std::max(flight.deepest, -plan.plane.distance(Vec3(p.transpose())));
  };
  BoundaryConditions free;
  free.fixed.assign(3 * network.nodes(), 0);
  free.prescribed = NodalVectors::Zero(network.nodes(), 3);
  free.external = flight.mass * plan.acceleration.transpose();
  flight.energy_at_start = energy_of(network.X, options.velocity);
  flight.spin_at_start = Flight::spin_of(network.X, options.velocity, flight.mass);
  const DynamicsResult result = run_dynamics(
      model, density, [&](double) { return free; }, options);
  flight.message = result.state.message;
  flight.duration = result.time;
  flight.impulse = contact.take_impulse();
  flight.bounce = contact.bounce();
  flight.energy = energy_of(flight.x, flight.v);
  return flight;
}

/// A body of cut cells, and the points of its surface.
struct CutFlyer {
  MassSpringModel model;
  PointWeights points;
};

inline CutFlyer cut_flyer(const Mesh& body, double edge, const IsotropicMaterial& material) {
  EmbeddedModel built = build_cut(model("hybmss_avg"), cut_body(grid_about(body, edge), body), {}, Mesh{}, material);
  return {std::move(built.model), std::move(built.embedding.surface)};
}

}  // namespace springproof::test
