// Motion of bodies of cut cells.
#include <gtest/gtest.h>

#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/time_step.h"
#include "msm/models.h"
#include "support/refined_cells.h"
#include "support/two_materials.h"
#include "support/zoo.h"

namespace springproof::cut_motion_test {
namespace {

const IsotropicMaterial material{1e4, 0.4, 1100};

/// Round bars of two cells, lying anyhow; of the second and fourth some cells are halved once or twice, and the third
/// to fifth are of two materials, of which the fifth has bonds that turn.
std::vector<MassSpringModel> bars() {
  const double edge = 0.5;
  const Mesh body = test::mapped(test::cylinder(3, 8, 12), test::random_placement(2, edge));
  const VoxelGrid grid = test::grid_about(body, edge);
  std::vector<MassSpringModel> bars;
  for (const VoxelGrid& g : {grid, test::halved_at_random(grid, 2, 8)})
    bars.push_back(build_cut(test::model("hybmss_avg"), cut_body(g, body), {}, Mesh{}, material).model);
  const Mesh halves = test::with_materials(test::cylinder(3, 8, 12), [](const Vec3& x) { return x[2] > 1.5; });
  const Mesh both = test::mapped(halves, test::random_placement(2, edge));
  for (const VoxelGrid& g : {grid, test::halved_at_random(grid, 2, 8)}) {
    bars.push_back(
        build_cut(test::model("hybmss_avg"), cut_body(g, both), {}, Mesh{}, material, {{2e4, 0.3, 3000}}).model);
    soften_bonds(bars.back(), material.density);
  }
  bars.push_back(
      build_cut(test::model("hybmss_avg"), cut_body(grid, both), {}, Mesh{}, material, {{2e4, 0.49, 3000}}).model);
  EXPECT_GT(bars[1].network.cells.carried.size(), 50u);
  EXPECT_GT(bars[3].network.bonds.size(), 20u);
  return bars;
}

LoadPath no_loads(const Network& network) {
  return [&](double) {
    return BoundaryConditions{std::vector<char>(network.X.size(), 0), std::vector<int>(network.X.size(), -1),
                              NodalVectors::Zero(network.nodes(), 3), NodalVectors::Zero(network.nodes(), 3)};
  };
}

/// A bent and turned bar is let go: it swings, and goes nowhere.
void expect_conserved(const MassSpringModel& model) {
  const Network& network = model.network;
  const Eigen::VectorXd mass = masses(network, material.density), per_mass = inverse_masses(network, material.density);
  for (const Integrator integrator : {Integrator::explicit_euler, Integrator::energy_momentum}) {
    const bool implicit = integrator == Integrator::energy_momentum;
    DynamicsOptions options;
    options.integrator = integrator;
    options.start = network.X;
    for (auto x : options.start.rowwise()) x[1] += 0.1 * x[0] * x[0] + 0.05 * x[2] * x[2] + 0.1 * x[2];
    const double start = energy(model, options.start), dt = safe_time_step(model, material.density);
    options.time_step = implicit ? 4 * dt : 0.5 * dt;
    options.duration = 200 * dt;
    double energy_off = 0, momentum = 0, spin = 0, moving = 0, turning = 0;
    options.after_step = [&](const MotionSample& at) {
      const NodalVectors& x = at.x;
      NodalVectors v = at.v;
      if (!implicit) {  // the velocity of a step is half a step behind
        const NodalVectors f = forces(model, x);
        for (Eigen::Index n = 0; n < v.rows(); ++n) v.row(n) += *options.time_step / 2 * per_mass[n] * f.row(n);
      }
      double kinetic = 0, speeds = 0, spins = 0;
      Vec3 p = Vec3::Zero(), L = Vec3::Zero();
      for (Eigen::Index n = 0; n < v.rows(); ++n) {
        const Vec3 X = x.row(n).transpose(), mv = mass[n] * v.row(n).transpose();
        kinetic += mv.dot(v.row(n).transpose()) / 2;
        p += mv;
        L += X.cross(mv);
        speeds += mv.norm();
        spins += X.cross(mv).norm();
      }
      energy_off = std::max(energy_off, std::abs(kinetic + energy(model, x) - start));
      momentum = std::max(momentum, p.norm());
      spin = std::max(spin, L.norm());
      moving = std::max(moving, speeds);
      turning = std::max(turning, spins);
    };
    const DynamicsResult result = run_dynamics(model, material.density, no_loads(network), options);
    ASSERT_TRUE(result.state.ok) << result.state.message;
    EXPECT_LT(momentum, 1e-9 * moving);
    EXPECT_LT(energy_off, (implicit ? 1e-6 : 0.02) * start);
    EXPECT_LT(spin, (implicit ? 1e-7 : 1e-10) * turning);
    EXPECT_GT(moving * moving, 0.01 * start * mass.sum());
  }
}

TEST(CutMotion, KeepsMomentaAndEnergy) {
  for (const MassSpringModel& model : bars()) expect_conserved(model);
}

/// The safe step is one: just below it a motion stays bounded.
void expect_stable(const MassSpringModel& model) {
  DynamicsOptions options;
  options.start = model.network.X + test::noise(model.network.nodes(), 1e-4);
  options.time_step = safe_time_step(model, material.density);
  options.duration = 3000 * *options.time_step;
  const double start = energy(model, options.start);
  double largest = 0;
  options.stride = 100;
  options.after_step = [&](const MotionSample& at) {
    const NodalVectors& x = at.x;
    largest = std::max(largest, energy(model, x));
  };
  EXPECT_TRUE(run_dynamics(model, material.density, no_loads(model.network), options).state.ok);
  EXPECT_LT(largest, 10 * start);
  options.time_step = 1.001 * *options.time_step;
  EXPECT_THROW(run_dynamics(model, material.density, no_loads(model.network), options), InputError);
}

// Bonds of one material with itself, of cells as small as a hundredth: the worst for the step.
TEST(CutMotion, SoftenedBondsLeaveMostOfTheStep) {
  const Mesh ball = test::ball_in_cube(8, {0.1, 0.2, -0.05});
  const VoxelGrid grid{Vec3::Constant(-2), 0.5, {8, 8, 8}};
  for (const double contrast : {1.0, 10.0}) {
    MassSpringModel model =
        build_cut(test::model("hybmss_avg"), cut_body(grid, ball), {}, Mesh{}, {1, 0.3, 1}, {{contrast, 0.3, 1}}).model;
    const double stiff = safe_time_step(model, 1);
    soften_bonds(model, 1);
    const double soft = safe_time_step(model, 1);
    MassSpringModel cells = model;
    cells.network.bonds.clear();
    EXPECT_GT(soft, 0.6 * safe_time_step(cells, 1)) << contrast;
    EXPECT_LT(stiff, 0.9 * soft) << contrast;
  }
}

TEST(CutMotion, IsStableAtTheSafeStep) {
  for (const MassSpringModel& model : bars()) expect_stable(model);
}

}  // namespace
}  // namespace springproof::cut_motion_test
