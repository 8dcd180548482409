// Bodies that fall on a rigid plane.
#include "msm/dynamics/terms/plane_contact.h"

#include <gtest/gtest.h>

#include "msm/dynamics/time_step.h"
#include "support/flight.h"

namespace springproof::plane_contact_test {
namespace {

constexpr double density = 1000, E = 1e5, c = 10;  // of sound in a bar [m/s]
using test::Flight, test::FlightPlan, test::fly;

/// 1 m x 0.1 x 0.1 m along x, nu = 0.
MassSpringModel bar(const char* name, int along) {
  const int across = std::max(1, along / 10);
  return build_model(test::model(name), block_mesh({1, 0.1, 0.1}, {along, across, across}), {E, 0, density});
}

Flight against_wall(const char* name, int cells) {
  FlightPlan plan{.duration = 0.3, .velocity = {-0.01, 0, 0}};
  plan.plane.point = {-1e-4, 0, 0};
  plan.plane.normal = Vec3::UnitX();
  return fly(bar(name, cells), density, plan);
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
    FlightPlan plan{.duration = 0.3, .velocity = {0.05, 0.02, -0.1}};
    Plane& plane = plan.plane;
    plane.normal = Vec3(0.3, -0.2, 1).normalized();
    double nearest = 1;
    for (Eigen::Index n = 0; n < model.network.X.rows(); ++n)
      nearest = std::min(nearest, plane.normal.dot(Vec3(model.network.X.row(n).transpose())));
    plane.point = (nearest - 1e-3) * plane.normal;
    for (const double friction : {0.0, 0.3}) {
      plane.friction = friction;
      const Flight f = fly(model, density, plan);
      const Vec3 change = f.momentum() - f.mass.sum() * plan.velocity, turned = f.spin() - f.spin_at_start;
      EXPECT_LT((change - f.impulse.linear).norm(), 1e-12 * change.norm()) << name;
      EXPECT_LT((turned - f.impulse.angular).norm(), 1e-11 * turned.norm()) << name;
      const double along = plane.normal.dot(change), across = (change - along * plane.normal).norm();
      EXPECT_GT(along, 0);
      EXPECT_LE(across, friction * along + 1e-12 * along) << name;
      EXPECT_GE(across, friction > 0 ? 0.1 * along : 0) << name;
      EXPECT_LT(f.energy, 1.001 * f.energy_at_start) << name;
      EXPECT_LT(f.deepest, 1e-12);
    }
  }
}

const Integrator large_steps[] = {Integrator::energy_momentum, Integrator::implicit_euler};

TEST(PlaneContact, InLargeStepsMomentaAreTheImpulsesAndEnergyIsNotGained) {
  const MassSpringModel model =
      build_model(test::model("hybmss_avg"), block_mesh({0.4, 0.4, 0.4}, {4, 4, 4}), {E, 0.25, density});
  for (const Integrator integrator : large_steps) {
    FlightPlan plan{.duration = 0.3, .velocity = {0.05, 0.02, -0.1}};
    plan.plane.normal = Vec3(0.3, -0.2, 1).normalized();
    plan.plane.point = -(0.2 * 0.4 + 1e-3) / Vec3(0.3, -0.2, 1).norm() * plan.plane.normal;
    plan.options.integrator = integrator;
    plan.options.time_step = 4 * safe_time_step(model, density);
    const Flight f = fly(model, density, plan);
    const Vec3 change = f.momentum() - f.mass.sum() * plan.velocity, turned = f.spin() - f.spin_at_start;
    EXPECT_EQ(f.message, "") << name_of(integrator);
    EXPECT_LT((change - f.impulse.linear).norm(), 1e-8 * change.norm());
    EXPECT_LT((change - plan.plane.normal.dot(change) * plan.plane.normal).norm(), 1e-8 * change.norm());
    EXPECT_GT(plan.plane.normal.dot(change), 0);
    if (integrator == Integrator::energy_momentum) {
      EXPECT_LT((turned - f.impulse.angular).norm(), 1e-7 * turned.norm());
    }
    EXPECT_LT(f.most_energy, (1 + 1e-9) * f.energy_at_start) << name_of(integrator);
    EXPECT_LT(f.deepest, 1e-8 * 0.1);
  }
}

TEST(PlaneContact, InLargeStepsAnElasticBarLeavesAWall) {
  for (const double ratio : {1.0, 4.0}) {
    const MassSpringModel model = bar("hybmss_avg", 20);
    FlightPlan plan{.duration = 0.3, .velocity = {-0.01, 0, 0}};
    plan.plane.point = {-1e-4, 0, 0};
    plan.plane.normal = Vec3::UnitX();
    plan.options.integrator = Integrator::energy_momentum;
    plan.options.time_step = ratio * safe_time_step(model, density);
    const Flight f = fly(model, density, plan);
    ASSERT_TRUE(f.bounce) << ratio;
    EXPECT_NEAR(f.bounce->end - f.bounce->begin, 2 / c, 0.1 * 2 / c);
    EXPECT_NEAR(-f.bounce->velocity_after / f.bounce->velocity_before, 1, ratio > 1 ? 0.2 : 0.1);
  }
}

TEST(PlaneContact, InLargeStepsARestingBlockHasItsWeight) {
  const MassSpringModel model =
      build_model(test::model("hybmss_avg"), block_mesh({0.4, 0.3, 0.2}, {4, 3, 2}), {E, 0.25, density});
  FlightPlan plan{.duration = 2, .acceleration = {0, 0, -9.81}};
  plan.plane.point = {0, 0, -1e-3};
  plan.options.integrator = Integrator::implicit_euler;
  plan.options.time_step = 4 * safe_time_step(model, density);
  const Flight first = fly(model, density, plan);
  plan.duration = 3;
  const Flight second = fly(model, density, plan);
  EXPECT_EQ(second.message, "");
  const double weight = 9.81 * first.mass.sum() * (second.duration - first.duration);
  EXPECT_NEAR(second.impulse.linear[2] - first.impulse.linear[2], weight, 1e-6 * weight);
  const Vec3 turning = second.impulse.angular - first.impulse.angular;
  EXPECT_NEAR(turning[0], 0.15 * weight, 1e-6 * weight);
  EXPECT_NEAR(turning[1], -0.2 * weight, 1e-6 * weight);
}

TEST(PlaneContact, WhatLargeStepsDoNotHaveIsRefused) {
  const MassSpringModel model = bar("hybmss_avg", 10);
  const Eigen::VectorXd mass = masses(model.network, density);
  Plane rough;
  rough.friction = 0.1;
  PointWeights middle(1, mass.size());
  middle.insert(0, 0) = middle.insert(0, 1) = 0.5;
  PlaneContact with_friction(rough, mass, 1), of_points({}, mass, 1, middle), smooth({}, mass, 1);
  DynamicsOptions options;
  for (const Integrator integrator : large_steps) {
    options.integrator = integrator;
    for (PlaneContact* contact : {&with_friction, &of_points}) {
      options.contact = contact;
      EXPECT_THROW(checked_time_step(model, density, options), InputError);
    }
    options.contact = &smooth;
    EXPECT_NO_THROW(checked_time_step(model, density, options));
  }
}

}  // namespace
}  // namespace springproof::plane_contact_test
