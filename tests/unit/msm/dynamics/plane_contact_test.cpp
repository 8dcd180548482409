// Bodies that fall on a rigid plane.
#include "msm/dynamics/plane_contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msm/dynamics/dynamics.h"
#include "support/zoo.h"

namespace springproof::plane_contact_test {
namespace {

constexpr double density = 1000, E = 1e5, c = 10;  // of sound in a bar [m/s]

struct Flight {
  NodalVectors x, v;
  Vec3 impulse = Vec3::Zero();
  std::optional<Bounce> bounce;
  double mass = 0, energy_lost = 0;  ///< of the kinetic energy at the start
};

/// A free body without load flies with `velocity`.
Flight fly(const MassSpringModel& model, const Plane& plane, const Vec3& velocity, double duration) {
  const Eigen::VectorXd mass = masses(model.network, density);
  PlaneContact contact(plane, mass, 0.02);
  DynamicsOptions options;
  options.contact = &contact;
  options.duration = duration;
  options.velocity = NodalVectors(model.network.X.rows(), 3);
  options.velocity.rowwise() = velocity.transpose();
  Flight flight;
  options.after_step = [&](double, const NodalVectors& x, const NodalVectors& v, const BoundaryConditions&) {
    flight.x = x;
    flight.v = v;
  };
  BoundaryConditions free;
  free.fixed.assign(3 * model.network.nodes(), 0);
  free.prescribed = free.external = NodalVectors::Zero(model.network.nodes(), 3);
  EXPECT_TRUE(run_dynamics(
                  model, density, [&](double) { return free; }, options)
                  .state.ok);
  flight.impulse = contact.take_impulse();
  flight.bounce = contact.bounce();
  flight.mass = mass.sum();
  const double kinetic = 0.5 * (flight.v.rowwise().squaredNorm().array() * mass.array()).sum();
  flight.energy_lost = 1 - (kinetic + energy(model, flight.x)) / (0.5 * flight.mass * velocity.squaredNorm());
  return flight;
}

/// 1 m x 0.1 x 0.1 m along x, nu = 0.
MassSpringModel bar(const char* name, int along) {
  const int across = std::max(1, along / 10);
  return build_model(test::model(name), block_mesh({1, 0.1, 0.1}, {along, across, across}), {E, 0, density});
}

Flight against_wall(const char* name, int cells) {
  Plane wall;
  wall.point = {-1e-4, 0, 0};
  wall.normal = Vec3::UnitX();
  return fly(bar(name, cells), wall, {-0.01, 0, 0}, 0.3);
}

// The wave runs to the free end and back in 2 L / c and leaves nothing behind (Timoshenko and Goodier, sec. 168).
TEST(PlaneContact, AnElasticBarLeavesAWallAsItCame) {
  for (const char* name : {"hybmss", "hybmss_avg"}) {
    double last = 1;
    for (const int cells : {10, 20, 40}) {
      const Flight f = against_wall(name, cells);
      ASSERT_TRUE(f.bounce) << name << cells;
      const double loss = 1 + f.bounce->velocity_after / f.bounce->velocity_before;
      EXPECT_LT(loss, 0.7 * last) << name << cells << ", first order";
      last = loss;
      EXPECT_NEAR(f.bounce->velocity_before, -0.01, 1e-12);
      if (cells < 40) continue;
      EXPECT_NEAR(f.bounce->end - f.bounce->begin, 2 / c, 0.02 * 2 / c) << name;
      EXPECT_NEAR(loss, 0, 0.04) << name;
    }
  }
}

TEST(PlaneContact, TheImpulseIsTheChangeOfMomentumAndEnergyIsNotGained) {
  for (const char* name : {"hybmss_avg", "msm_random"}) {
    const MassSpringModel model =
        build_model(test::model(name), block_mesh({0.4, 0.4, 0.4}, {4, 4, 4}), {E, 0.25, density});
    Plane plane;
    plane.normal = Vec3(0.3, -0.2, 1).normalized();
    double nearest = 1;
    for (Eigen::Index n = 0; n < model.network.X.rows(); ++n)
      nearest = std::min(nearest, plane.normal.dot(Vec3(model.network.X.row(n).transpose())));
    plane.point = (nearest - 1e-3) * plane.normal;
    const Vec3 velocity(0.05, 0.02, -0.1);
    for (const double friction : {0.0, 0.3}) {
      plane.friction = friction;
      const Flight f = fly(model, plane, velocity, 0.3);
      const Vec3 momentum = f.v.transpose() * masses(model.network, density), change = momentum - f.mass * velocity;
      EXPECT_LT((change - f.impulse).norm(), 1e-12 * change.norm()) << name;
      const double along = plane.normal.dot(change), across = (change - along * plane.normal).norm();
      EXPECT_GT(along, 0);
      EXPECT_LE(across, friction * along + 1e-12 * along) << name;
      EXPECT_GE(across, friction > 0 ? 0.1 * along : 0) << name;
      EXPECT_GT(f.energy_lost, -1e-3) << name;
      for (Eigen::Index n = 0; n < f.x.rows(); ++n) EXPECT_GT(plane.distance(f.x.row(n).transpose()), -1e-12);
    }
  }
}

TEST(PlaneContact, LargeStepsHaveNone) {
  const MassSpringModel model = bar("hybmss_avg", 10);
  PlaneContact contact({}, masses(model.network, density), 1);
  DynamicsOptions options;
  options.contact = &contact;
  options.integrator = Integrator::energy_momentum;
  EXPECT_THROW(checked_time_step(model, density, options), InputError);
}

}  // namespace
}  // namespace springproof::plane_contact_test
