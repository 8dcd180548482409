// How motions start: the course of loads, and the order of the first step.
#include <gtest/gtest.h>

#include "msm/dynamics/dynamics.h"
#include "problem/course.h"
#include "support/zoo.h"

namespace springproof::start_test {
namespace {

TEST(Course, IsARampAPulseOrAWave) {
  EXPECT_EQ(Course{}.factor(0), 1);
  EXPECT_EQ(Course{}.settled(), 0);
  const Course ramp{.ramp = 2}, pulse{.pulse = 0.1}, wave{.frequency = 4};
  EXPECT_EQ(ramp.factor(0.5), 0.25);
  EXPECT_EQ(ramp.factor(5), 1);
  EXPECT_NEAR(pulse.factor(0.05), 1, 1e-15);
  EXPECT_EQ(pulse.factor(0.1), 0);
  EXPECT_EQ(pulse.settled(), 0.1);
  EXPECT_NEAR(wave.factor(0.0625), 1, 1e-15);
  EXPECT_EQ(wave.settled(), std::numeric_limits<double>::infinity());
  for (const Course& course : {Course{}, ramp, pulse, wave}) {
    double sum = 0;
    constexpr int steps = 30000;
    for (int i = 0; i < steps; ++i) sum += 3.0 / steps * course.factor(3.0 * (i + 0.5) / steps);
    EXPECT_NEAR(course.integral(3), sum, 1e-6);
  }
}

/// A cube of springs on its support, thrown or at rest, under a force.
struct Thrown {
  Mesh mesh = block_mesh({1, 1, 1}, {3, 3, 3});
  EmbeddedModel built = build_embedded(test::model("hybmss_avg"), mesh, {1e4, 0.25, 1000});

  /// The displacement at `time`; an empty velocity: the first step as published.
  NodalVectors after(double time, int steps, const std::optional<Vec3>& velocity, Course course = {}) const {
    DynamicsOptions options;
    options.time_step = time / steps;
    options.duration = time * (1 - 1e-9);
    options.course = course;
    if (velocity) options.velocity = Eigen::VectorXd::Ones(built.model.network.nodes()) * velocity->transpose();
    const std::vector<Load> loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}, PatchForce{"z_max", {2, 0, 0}}};
    const LoadPath path = [&](double factor) {
      return transfer(loads, mesh, built.embedding, built.model.network, 1000, Kinematics::finite, factor);
    };
    return run_dynamics(built.model, 1000, path, options).state.displacement;
  }
};

TEST(StartOfMotion, WithAVelocityIsOfSecondOrder) {
  const Thrown cube;
  for (const auto& velocity : {std::optional<Vec3>(Vec3::Zero()), std::optional<Vec3>(Vec3(0.1, 0, 0.2))}) {
    const NodalVectors a = cube.after(0.2, 40, velocity), b = cube.after(0.2, 80, velocity),
                       c = cube.after(0.2, 160, velocity);
    EXPECT_NEAR((b - a).norm() / (c - b).norm(), 4, 0.4);
  }
  const NodalVectors a = cube.after(0.2, 40, {}), b = cube.after(0.2, 80, {}), c = cube.after(0.2, 160, {});
  EXPECT_NEAR((b - a).norm() / (c - b).norm(), 2, 0.3);  // as published
}

TEST(StartOfMotion, AWaveShakes) {
  const Thrown cube;
  const NodalVectors still = cube.after(0.5, 200, Vec3(0, 0, 0), {.pulse = 1e-9});
  EXPECT_LT(still.norm(), 1e-12);
  const NodalVectors shaken = cube.after(0.5, 200, Vec3(0, 0, 0), {.frequency = 2});
  EXPECT_GT(shaken.norm(), 1e-4);
}

}  // namespace
}  // namespace springproof::start_test
