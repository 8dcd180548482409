// Bodies of several materials: exact in series and in parallel, pressures that jump, contrast that costs nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "fem_reference/solve_grid.h"
#include "support/fem_block.h"
#include "support/two_materials.h"

namespace springproof::fem_regions_test {
namespace {

const Vec3 size(2, 1, 1);
const std::optional<double> is_free;

/// A bar, its half beyond the middle along an axis of a second material.
fem::GridProblem bar(const std::string& element, int axis, const IsotropicMaterial& first,
                     const IsotropicMaterial& second, const std::array<int, 3>& cells = {4, 2, 2}) {
  fem::GridProblem problem;
  const Mesh block = block_mesh(size, cells);
  problem.coarse = element[0] == 'p' ? test::tetrahedra_block(block) : block;
  problem.degree = element[1] - '0';
  problem.material = first;
  problem.regions = {second};
  problem.tolerance = 1e-8;
  const auto add = [&](const auto& cell) {
    double middle = 0;
    for (const int n : cell) middle += problem.coarse.nodes(n, axis) / static_cast<double>(cell.size());
    problem.coarse.materials.push_back(middle > size[axis] / 2);
  };
  for (const Hexahedron& cell : problem.coarse.hexahedra) add(cell);
  for (const Tetrahedron& cell : problem.coarse.tetrahedra) add(cell);
  return problem;
}

/// Walls without friction on all sides but x_max, where there is a pressure.
std::vector<Load> confined(double pressure) {
  std::vector<Load> loads = {PrescribedDisplacement{"x_min", {0.0, is_free, is_free}}, Pressure{"x_max", pressure}};
  for (const char* side : {"y_min", "y_max"}) loads.push_back(PrescribedDisplacement{side, {is_free, 0.0, is_free}});
  for (const char* side : {"z_min", "z_max"}) loads.push_back(PrescribedDisplacement{side, {is_free, is_free, 0.0}});
  return loads;
}

double confined_modulus(const IsotropicMaterial& m) { return lame_lambda(m) + 2 * shear_modulus(m); }

class FemRegions : public testing::TestWithParam<std::string> {};

TEST_P(FemRegions, InSeriesAreExactAtAnyContrast) {
  for (const double contrast : {1e-4, 1e4})
    for (const double nu : {0.0, 0.3, 0.499}) {
      const IsotropicMaterial first{1e4, 0.3, 1000}, second{contrast * 1e4, nu, 1000};
      fem::GridProblem problem = bar(GetParam(), 0, first, second);
      problem.loads = confined(10);
      problem.tolerance = 1e-9;  // round-off of the stiffer part's forces stops the residual at 4e-10
      problem.points = NodalVectors(2, 3);
      problem.points << 1, 0.5, 0.5, 2, 0.5, 0.5;
      problem.stress_points = problem.points;
      const fem::Solution s = fem::solve_grid(problem);
      ASSERT_TRUE(s.ok) << s.message << " " << s.form;
      const double at_middle = -10 / confined_modulus(first), beyond = -10 / confined_modulus(second);
      EXPECT_NEAR(s.displacement(0, 0) / at_middle, 1, 1e-6) << contrast << " " << nu << " " << s.form;
      EXPECT_NEAR(s.displacement(1, 0) / (at_middle + beyond), 1, 1e-6) << contrast << " " << nu << " " << s.form;
      EXPECT_NEAR(s.stress(0, 1), -10 * 0.3 / 0.7, 1e-4) << "where they meet, of the first";
      EXPECT_NEAR(s.stress(1, 1), -10 * nu / (1 - nu), 1e-4);
      ASSERT_EQ(s.regions.size(), 1u);
      EXPECT_NEAR(s.regions[0].stress(0, 0) / -10, 1, 1e-6);
      EXPECT_NEAR(s.regions[0].stress(0, 1), -10 * nu / (1 - nu), 1e-5);
      ASSERT_EQ(s.interfaces.size(), 1u);
      EXPECT_NEAR(s.interfaces[0].force[0], 10, 1e-5);            // the first half bears the second
      EXPECT_NEAR(s.regions[0].volume_change / beyond, 1, 5e-5);  // 1e4 x residual
      EXPECT_NEAR(s.regions[0].displacement[0] / (at_middle + beyond / 2), 1, 1e-6);
      EXPECT_NEAR(s.regions[0].energy / (5 * -beyond), 1, 5e-5);
    }
}

TEST_P(FemRegions, InParallelShareTheForceByTheirModuli) {
  const IsotropicMaterial first{1e4, 0.45, 1000}, second{1e7, 0.45, 1000};
  fem::GridProblem problem = bar(GetParam(), 2, first, second);
  problem.loads = {PrescribedDisplacement{"x_min", {0.0, is_free, is_free}},
                   PrescribedDisplacement{"x_max", {0.01, is_free, is_free}},
                   PrescribedDisplacement{"y_min", {is_free, 0.0, is_free}},
                   PrescribedDisplacement{"z_min", {is_free, is_free, 0.0}}};
  const fem::Solution s = fem::solve_grid(problem);
  ASSERT_TRUE(s.ok) << s.message;
  EXPECT_NEAR(s.reactions[1].force[0] / (0.005 * (1e4 + 1e7) / 2), 1, 1e-6) << s.form;
}

/// Uniaxial strain to the stretch l in a wall without friction: first Piola-Kirchhoff stress, and energy per volume.
struct Confined {
  double stress, energy;

  Confined(const std::string& law, const IsotropicMaterial& m, double l) {
    const double log_l = std::log(l), mu = shear_modulus(m), lambda = lame_lambda(m);
    stress = confined_modulus(m) * log_l / l;
    energy = confined_modulus(m) / 2 * log_l * log_l;
    if (law == "hencky") return;
    stress = mu * (l - 1 / l) + lambda * log_l / l;
    energy = mu / 2 * (l * l - 1 - 2 * log_l) + lambda / 2 * log_l * log_l;
  }
};

/// Stretches of two halves in series whose mean is given.
std::pair<double, double> in_series(const std::string& law, const IsotropicMaterial& first,
                                    const IsotropicMaterial& second, double mean) {
  double low = std::max(0.01, 2 * mean - 2),
         high = std::min(2 * mean - 0.01, 2.0);  // stress rises up to a stretch of e
  for (int step = 0; step < 200; ++step) {
    const double l = (low + high) / 2;
    (Confined(law, first, l).stress < Confined(law, second, 2 * mean - l).stress ? low : high) = l;
  }
  return {low, 2 * mean - low};
}

TEST_P(FemRegions, InSeriesAreExactAtLargeStrain) {
  for (const auto& [law, mean] : {std::pair("hencky", 0.8), std::pair("neo_hooke", 1.2)})
    for (const auto& [contrast, nu] : {std::pair(1e-2, 0.0), std::pair(1e4, 0.499)}) {
      const IsotropicMaterial first{1e4, 0.3, 1000}, second{contrast * 1e4, nu, 1000};
      fem::GridProblem problem = bar(GetParam(), 0, first, second);
      problem.law = law;
      problem.loads = confined(0);
      problem.loads[1] = PrescribedDisplacement{"x_max", {2 * (mean - 1), is_free, is_free}};
      problem.points = NodalVectors(1, 3);
      problem.points << 1, 0.5, 0.5;
      const fem::Solution s = fem::solve_grid(problem);
      ASSERT_TRUE(s.ok) << s.message << " " << s.form << contrast << " " << nu;
      const auto [a, b] = in_series(law, first, second, mean);
      const Confined at(law, second, b);
      EXPECT_NEAR(s.displacement(0, 0), a - 1, 1e-6) << contrast << " " << nu << " " << s.form;
      EXPECT_NEAR(s.reactions[1].force[0] / at.stress, 1, 1e-6) << law << mean << contrast << " " << nu;
      ASSERT_EQ(s.regions.size(), 1u);
      EXPECT_NEAR(s.regions[0].stress(0, 0) / at.stress, 1, 1e-5);  // the area stays what it is
      EXPECT_NEAR(s.regions[0].volume_change, b - 1, 1e-6);
      EXPECT_NEAR(s.interfaces.at(0).force[0] / -at.stress, 1, 1e-5);
      EXPECT_NEAR(s.regions[0].energy / at.energy, 1, 1e-4) << law << mean << contrast << " " << nu;
    }
}

TEST_P(FemRegions, InParallelShareTheForceAtLargeStrain) {
  const IsotropicMaterial first{1e4, 0.45, 1000}, second{1e7, 0.45, 1000};
  fem::GridProblem problem = bar(GetParam(), 2, first, second);
  problem.law = "hencky";
  problem.loads = {PrescribedDisplacement{"x_min", {0.0, is_free, is_free}},
                   PrescribedDisplacement{"x_max", {0.4, is_free, is_free}},
                   PrescribedDisplacement{"y_min", {is_free, 0.0, is_free}},
                   PrescribedDisplacement{"z_min", {is_free, is_free, 0.0}}};
  const fem::Solution s = fem::solve_grid(problem);
  ASSERT_TRUE(s.ok) << s.message;
  EXPECT_NEAR(s.reactions[1].force[0] / ((1e4 + 1e7) / 2 * std::log(1.2) / 1.2), 1, 1e-6) << s.form;
  EXPECT_NEAR(s.regions[0].stress(0, 0) / (1e7 * std::log(1.2) / std::pow(1.2, 1 - 2 * 0.45)), 1, 1e-6);
}

TEST_P(FemRegions, WeighWhatTheirDensitiesAre) {
  fem::GridProblem problem = bar(GetParam(), 0, {1e4, 0.3, 1000}, {1e4, 0.3, 3000});
  problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, Gravity{{0, 0, -10}}};
  const fem::Solution s = fem::solve_grid(problem);
  EXPECT_NEAR(s.reactions[0].force[2], 4e4, 1e-3);
}

/// In a wall without friction.
double first_frequency_of(const fem::GridProblem& bar) {
  return test::first_frequency({confined_modulus(bar.material), bar.material.density, 1},
                               {confined_modulus(bar.regions[0]), bar.regions[0].density, 1});
}

TEST_P(FemRegions, VibrateAsRodsOfTwoParts) {
  for (const IsotropicMaterial& second : {IsotropicMaterial{1e6, 0.3, 3000}, {1e6, 0.499, 500}, {2e3, 0.2, 2000}}) {
    fem::GridProblem problem = bar(GetParam(), 0, {1e4, 0.3, 1000}, second, {8, 4, 4});
    problem.loads = confined(0);
    problem.loads.erase(problem.loads.begin() + 1);
    problem.modes = 8;
    problem.points = problem.coarse.nodes;
    const fem::Solution s = fem::solve_grid(problem);
    ASSERT_TRUE(s.ok) << s.message;
    const double expected = first_frequency_of(problem);
    double nearest = 0;
    for (const double f : s.frequencies)
      if (std::abs(f - expected) < std::abs(nearest - expected)) nearest = f;
    EXPECT_NEAR(nearest / expected, 1, problem.degree == 2 ? 1e-4 : 0.01) << second.youngs_modulus;
  }
}

TEST_P(FemRegions, SwingInTheirPeriod) {
  for (const double nu : {0.3, 0.499}) {
    fem::GridProblem problem = bar(GetParam(), 0, {1e4, 0.3, 1000}, {1e6, nu, 3000});
    problem.law = "hencky";
    problem.loads = confined(10);
    const double period = 1 / first_frequency_of(problem);
    problem.motion = fem::MotionRequest{period, 0, {}, true};
    problem.steps = 100;
    problem.points = NodalVectors(1, 3);
    problem.points << 2, 0.5, 0.5;
    const fem::Solution s = fem::solve_grid(problem);
    ASSERT_TRUE(s.ok) << s.message;
    std::vector<double> crossings;
    for (std::size_t i = 1; i < s.path.size(); ++i) {
      const double before = s.path[i - 1](0, 0), now = s.path[i](0, 0);
      if (before * now < 0) crossings.push_back(s.time[i - 1] + (s.time[i] - s.time[i - 1]) * before / (before - now));
    }
    ASSERT_EQ(crossings.size(), 2u);
    EXPECT_NEAR(2 * (crossings[1] - crossings[0]) / period, 1, 0.01) << nu;
  }
}

TEST_P(FemRegions, KeepEnergyAndMomentaInFlight) {
  fem::GridProblem problem = bar(GetParam(), 0, {1e4, 0.3, 1000}, {1e5, 0.49, 3000});
  problem.law = "hencky";
  problem.motion = fem::MotionRequest{.duration = 0.5, .velocity = {1, 0, 0}, .spin = {0, 0, 2}};
  problem.motion->energy_momentum = true;
  problem.steps = 20;
  problem.points = NodalVectors(0, 3);
  const fem::Solution s = fem::solve_grid(problem);
  ASSERT_TRUE(s.ok) << s.message;
  // Cubes of 1000 and 3000 kg, 0.75 and 0.25 m from the centre of mass.
  const double inertia = 4000 / 6. + 1000 * 0.75 * 0.75 + 3000 * 0.25 * 0.25;
  EXPECT_NEAR(s.kinetic_energy[0], (4000 + inertia * 4) / 2, 1e-6);
  for (std::size_t i = 0; i < s.time.size(); ++i) {
    EXPECT_NEAR(s.kinetic_energy[i] + s.elastic_energy[i], s.kinetic_energy[0], 1e-6 * s.kinetic_energy[0]);
    EXPECT_LT((s.angular_momentum[i] - s.angular_momentum[0]).norm(), 1e-6 * s.angular_momentum[0].norm());
  }
  EXPECT_GT(s.elastic_energy.back(), 1e-3 * s.kinetic_energy[0]);
}

TEST_P(FemRegions, OfOneMaterialAreNone) {
  fem::GridProblem problem = bar(GetParam(), 0, {1e4, 0.3, 1000}, {1e4, 0.3, 1000});
  problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, PatchForce{"x_max", {0, 0, -1}}};
  problem.points = problem.coarse.nodes;
  const fem::Solution two = fem::solve_grid(problem);
  problem.regions.clear();
  problem.coarse.materials.clear();
  const fem::Solution one = fem::solve_grid(problem);
  EXPECT_LT((two.displacement - one.displacement).norm(), 1e-6 * one.displacement.norm());
}

/// A block hung by its top, with a box of a second, heavier material in it: edges where the stress has no limit.
TEST_P(FemRegions, ABoxIsHeldByItsWeight) {
  for (const char* law : {"linear", "hencky"}) {
    fem::GridProblem problem = bar(GetParam(), 0, {1e4, 0.3, 10}, {1e6, 0.499, 50}, {8, 4, 4});
    problem.law = law;
    std::size_t number = 0;
    const auto mark = [&](const auto& cell) {
      Vec3 middle = Vec3::Zero();
      for (const int n : cell) middle += problem.coarse.nodes.row(n).transpose() / static_cast<double>(cell.size());
      problem.coarse.materials[number++] = (middle - size / 2).cwiseAbs().maxCoeff() < 0.25;
    };
    for (const Hexahedron& cell : problem.coarse.hexahedra) mark(cell);
    for (const Tetrahedron& cell : problem.coarse.tetrahedra) mark(cell);
    problem.loads = {PrescribedDisplacement{"z_max", {0.0, 0.0, 0.0}}, Gravity{{3, 0, -10}},
                     PatchForce{"x_max", {100, 0, 0}}};
    const fem::Solution s = fem::solve_grid(problem);
    ASSERT_TRUE(s.ok) << s.message;
    const double mass = 50 * std::pow(0.5, 3);
    ASSERT_EQ(s.interfaces.size(), 1u);
    EXPECT_LT((s.interfaces[0].force - mass * Vec3(-3, 0, 10)).norm(), 1e-6 * s.reactions[0].force.norm()) << s.form;
  }
}

INSTANTIATE_TEST_SUITE_P(Elements, FemRegions, testing::Values("q1", "q2", "p1", "p2"));

TEST(FemRegionsInBending, ConvergeInAsManyStepsAtAnyContrast) {
  std::map<double, int> steps;
  for (const double contrast : {1.0, 1e-4, 1e4}) {
    fem::GridProblem problem = bar("p2", 2, {1e4, 0.49, 1000}, {contrast * 1e4, 0.3, 1000});
    problem.tolerance = 1e-8;
    problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, PatchForce{"x_max", {0, 0, -1}}};
    const fem::Solution s = fem::solve_grid(problem);
    ASSERT_TRUE(s.ok) << s.message;
    steps[contrast] = s.iterations;
  }
  EXPECT_LE(steps[1e-4], 2 * steps[1]) << steps[1];
  EXPECT_LE(steps[1e4], 2 * steps[1]) << steps[1];
}

}  // namespace
}  // namespace springproof::fem_regions_test
