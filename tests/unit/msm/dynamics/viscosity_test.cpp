// Viscosity: what it resists, what it keeps, and what vibrations lose by it.
#include "msm/dynamics/terms/viscosity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/natural_modes.h"
#include "msm/dynamics/time_step.h"
#include "msm/laws/capabilities.h"
#include "support/zoo.h"

namespace springproof::viscosity_test {
namespace {

constexpr double density = 1000, retardation = 1e-3;

EmbeddedModel bar(const std::string& model, double nu, const Cells& cells = {8, 2, 2}) {
  const bool measured = model == "measured cells";
  EmbeddedModel bar =
      build_embedded(test::model(measured ? "hybmss_avg" : model), block_mesh({4, 1, 1}, cells), {1e4, nu, density});
  if (measured) bar.model = test::with_measured_cells(std::move(bar.model));
  return bar;
}

Viscosity viscosity_of(const MassSpringModel& model, double nu) {
  return Viscosity::of(model, {1e4, nu, density}, retardation);
}

NodalVectors viscous_forces(const MassSpringModel& model, double nu, const NodalVectors& x, const NodalVectors& v) {
  NodalVectors f = NodalVectors::Zero(x.rows(), 3);
  viscosity_of(model, nu).add_forces(model.network, x, v, f);
  return f;
}

/// Bent, stretched and turned.
NodalVectors deformed(const NodalVectors& X) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  NodalVectors x = X;
  for (Eigen::Index n = 0; n < X.rows(); ++n) {
    const Vec3 p = X.row(n).transpose();
    const Vec3 q(1.1 * p[0] + 0.05 * p[2] * p[0], 0.95 * p[1] + 0.02 * p[0] * p[0], p[2] - 0.03 * p[0] * p[1]);
    x.row(n) = (turn * q).transpose();
  }
  return x;
}

NodalVectors some_velocity(const NodalVectors& X) {
  NodalVectors v(X.rows(), 3);
  for (Eigen::Index i = 0; i < v.size(); ++i) v.data()[i] = std::sin(7.0 * static_cast<double>(i) + 1);
  return v;
}

const char* const any_model[] = {"hybmss", "hybmss_avg", "measured cells", "emsm", "msm_18", "msm_random"};
bool of_springs(const std::string& model) { return model.starts_with("msm_"); }
double own_ratio(const std::string& model) { return of_springs(model) ? 0.25 : 0.4; }

TEST(Viscosity, AtRestIsTheStiffnessTimesTheRetardation) {
  for (const auto& [name, nu] :
       {std::pair("hybmss_avg", -0.5), {"hybmss_avg", 0.0}, {"hybmss_avg", 0.45}, {"measured cells", 0.3}}) {
    const EmbeddedModel body = bar(name, nu);
    const NodalVectors &X = body.model.network.X, v = some_velocity(X);
    const NodalVectors elastic = (forces(body.model, X + 1e-6 * v) - forces(body.model, X - 1e-6 * v)) / 2e-6;
    const NodalVectors viscous = viscous_forces(body.model, nu, X, v);
    EXPECT_LT((viscous - retardation * elastic).norm(), 1e-7 * viscous.norm()) << name << nu;
  }
  const MassSpringModel boxes =
      build_model(test::model("hybmss_avg"), block_mesh({1, 0.3, 0.6}, {3, 2, 1}), {1e4, 0.3, density});
  const NodalVectors &of_boxes = boxes.network.X, speed = some_velocity(of_boxes);
  const NodalVectors expected =
      retardation * (forces(boxes, of_boxes + 1e-6 * speed) - forces(boxes, of_boxes - 1e-6 * speed)) / 2e-6;
  EXPECT_LT((viscous_forces(boxes, 0.3, of_boxes, speed) - expected).norm(), 1e-7 * expected.norm());
  for (const char* model : {"msm_18", "msm_random"}) {
    const EmbeddedModel springs = bar(model, 0.25);
    const NodalVectors &X = springs.model.network.X, v = some_velocity(X);
    const NodalVectors elastic = (forces(springs.model, X + 1e-6 * v) - forces(springs.model, X - 1e-6 * v)) / 2e-6;
    const NodalVectors viscous = viscous_forces(springs.model, 0.25, X, v);
    EXPECT_LT((viscous - retardation * elastic).norm(), 1e-7 * viscous.norm()) << model;
  }
}

TEST(Viscosity, OfAModelWithoutCellsButMoreThanSpringsIsRefused) {
  const EmbeddedModel body = bar("emsm_random", 0.25);
  EXPECT_NE(lacks(body.model, Capability::viscosity), "");
  EXPECT_FALSE(Viscosity::of(body.model, {1e4, 0.25, density}, 0).acts());
  EXPECT_THROW(viscosity_of(body.model, 0.25), InputError);
  EXPECT_THROW(Viscosity::of(bar("hybmss", 0.25).model, {1e4, 0.25, density}, -1e-3), InputError);
  for (const std::string model : any_model)
    EXPECT_EQ(lacks(bar(model, own_ratio(model)).model, Capability::viscosity), "");
}

TEST(Viscosity, ResistsNoRigidMotionOfADeformedBody) {
  for (const std::string model : any_model) {
    const double nu = own_ratio(model);
    const EmbeddedModel body = bar(model, nu);
    const NodalVectors x = deformed(body.model.network.X);
    NodalVectors v(x.rows(), 3);
    for (Eigen::Index n = 0; n < x.rows(); ++n)
      v.row(n) = (Vec3(1, -2, 3) + Vec3(2, 1, -3).cross(Vec3(x.row(n).transpose()))).transpose();
    const double size = viscous_forces(body.model, nu, x, some_velocity(x)).norm();
    EXPECT_LT(viscous_forces(body.model, nu, x, v).norm(), 1e-10 * size) << model;
  }
}

TEST(Viscosity, KeepsBothMomentaAndTakesEnergy) {
  for (const std::string model : any_model)
    for (const double nu : {-0.5, 0.25, 0.49}) {
      if (of_springs(model) && nu != 0.25) continue;
      const EmbeddedModel body = bar(model, nu);
      const NodalVectors x = deformed(body.model.network.X), v = some_velocity(x);
      const NodalVectors f = viscous_forces(body.model, nu, x, v);
      Vec3 moment = Vec3::Zero();
      for (Eigen::Index n = 0; n < x.rows(); ++n)
        moment += Vec3(x.row(n).transpose()).cross(Vec3(f.row(n).transpose()));
      EXPECT_LT(f.colwise().sum().norm(), 1e-11 * f.norm()) << model << nu;
      EXPECT_LT(moment.norm(), 1e-11 * f.norm()) << model << nu;
      EXPECT_LT(f.cwiseProduct(v).sum(), -1e-3 * f.norm() * v.norm()) << model << nu;
    }
}

TEST(Viscosity, DampsEveryModeByItsShare) {
  // By w time / 2 of critical damping; models whose own springs bend and twist less exactly, by a little else.
  for (const auto& [model, nu, within] : {std::tuple("hybmss_avg", -0.5, 1e-6),
                                          {"hybmss_avg", 0.0, 1e-6},
                                          {"hybmss_avg", 0.45, 1e-6},
                                          {"measured cells", 0.3, 1e-6},
                                          {"hybmss", -0.5, 0.35},
                                          {"hybmss", 0.45, 0.35},
                                          {"emsm", 0.45, 0.35},
                                          {"msm_random", 0.25, 1e-6}}) {
    const EmbeddedModel body = bar(model, nu, {16, 4, 4});
    const Network& network = body.model.network;
    const std::vector<char> none(3 * network.nodes(), 0);
    const NaturalModes modes = natural_modes(body.model, none, density, 0, 10);
    ASSERT_TRUE(modes.ok) << modes.message;
    for (std::size_t m = 0; m < modes.frequencies.size(); ++m) {
      const double w = 2 * std::numbers::pi * modes.frequencies[m];
      const double taken =
          -viscous_forces(body.model, nu, network.X, modes.shapes[m]).cwiseProduct(modes.shapes[m]).sum();
      EXPECT_NEAR(taken / (2 * w), w * retardation / 2, within * w * retardation / 2) << model << nu << m;
    }
  }
}

TEST(Viscosity, AMotionDecaysAsItsModeShould) {
  const double nu = 0.45, ratio = 0.05;
  for (const auto& [model, integrator] : {std::pair("hybmss_avg", Integrator::explicit_euler),
                                          {"hybmss_avg", Integrator::energy_momentum},
                                          {"measured cells", Integrator::explicit_euler},
                                          {"emsm", Integrator::explicit_euler},
                                          {"emsm", Integrator::energy_momentum}}) {
    const EmbeddedModel body = bar(model, nu);
    const Network& network = body.model.network;
    const std::vector<char> none(3 * network.nodes(), 0);
    const NaturalModes modes = natural_modes(body.model, none, density, 0, 1);
    ASSERT_TRUE(modes.ok);
    const double w = 2 * std::numbers::pi * modes.frequencies[0];
    DynamicsOptions options;
    options.integrator = integrator;
    if (integrator != Integrator::explicit_euler) options.time_step = 0.01 / modes.frequencies[0];
    options.viscosity = Viscosity::of(body.model, {1e4, nu, density}, 2 * ratio / w);
    options.velocity = 1e-6 * modes.shapes[0] / modes.shapes[0].cwiseAbs().maxCoeff();
    options.duration = 4 / modes.frequencies[0];
    const double before = options.velocity.squaredNorm() * density * 4 / network.nodes();
    double largest = 0;
    options.after_step = [&](const MotionSample& at) {
      const double time = at.time;
      const NodalVectors& v = at.v;
      if (time > 3.2 / modes.frequencies[0]) largest = std::max(largest, v.squaredNorm());
    };
    const DynamicsResult r = run_dynamics(
        body.model, density,
        [&](double) {
          BoundaryConditions bc;
          bc.fixed = none;
          bc.prescribed = bc.external = NodalVectors::Zero(network.X.rows(), 3);
          return bc;
        },
        options);
    ASSERT_GT(before, 0);
    EXPECT_GT(r.steps, 100);
    // Fastest at rest after three and a half periods.
    const double expected = std::exp(-ratio * w * 3.5 / modes.frequencies[0]);
    EXPECT_NEAR(std::sqrt(largest) / options.velocity.norm(), expected, (model[0] == 'e' ? 0.2 : 0.03) * expected)
        << model << " " << name_of(integrator);
  }
}

TEST(Viscosity, ItsStepIsSafeAndALargerOneIsRefused) {
  for (const std::string model : any_model) {
    const double nu = own_ratio(model);
    const EmbeddedModel body = bar(model, nu);
    const Network& network = body.model.network;
    const double elastic = safe_time_step(body.model, density);
    const Viscosity viscosity = Viscosity::of(body.model, {1e4, nu, density}, 3 * elastic);
    const double step = viscous_time_step(body.model, density, viscosity, elastic);
    EXPECT_LT(step, 0.5 * elastic);
    DynamicsOptions options;
    options.viscosity = viscosity;
    options.velocity = 1e-5 * some_velocity(network.X);
    options.time_step = 1.001 * step;
    EXPECT_THROW(checked_time_step(body.model, density, options), InputError);
    options.time_step = step;
    options.duration = 3000 * step;
    const LoadPath free = [&](double) {
      BoundaryConditions bc;
      bc.fixed.assign(3 * network.nodes(), 0);
      bc.prescribed = bc.external = NodalVectors::Zero(network.X.rows(), 3);
      return bc;
    };
    const DynamicsResult r = run_dynamics(body.model, density, free, options);
    const double start = 0.5 * options.velocity.rowwise().squaredNorm().dot(masses(network, density));
    EXPECT_LT(r.kinetic_energy, 0.9 * start) << model;
  }
}

}  // namespace
}  // namespace springproof::viscosity_test
