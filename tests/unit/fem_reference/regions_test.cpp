// Bodies of several materials: exact in series and in parallel, pressures that jump, contrast that costs nothing.
#include <gtest/gtest.h>

#include <map>

#include "fem_reference/solve_grid.h"
#include "support/fem_block.h"

namespace springproof::fem_regions_test {
namespace {

const Vec3 size(2, 1, 1);
const std::optional<double> is_free;

/// A bar of 8 x 4 x 4 cells, its half beyond the middle along an axis of a second material.
fem::GridProblem bar(const std::string& element, int axis, const IsotropicMaterial& first,
                     const IsotropicMaterial& second) {
  fem::GridProblem problem;
  const Mesh block = block_mesh(size, {8, 4, 4});
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
      const fem::Solution s = fem::solve_grid(problem);
      ASSERT_TRUE(s.ok) << s.message << " " << s.form;
      const double at_middle = -10 / confined_modulus(first), beyond = -10 / confined_modulus(second);
      EXPECT_NEAR(s.displacement(0, 0) / at_middle, 1, 1e-6) << contrast << " " << nu << " " << s.form;
      EXPECT_NEAR(s.displacement(1, 0) / (at_middle + beyond), 1, 1e-6) << contrast << " " << nu << " " << s.form;
      ASSERT_EQ(s.regions.size(), 1u);
      EXPECT_NEAR(s.regions[0].stress(0, 0) / -10, 1, 1e-6);
      EXPECT_NEAR(s.regions[0].stress(0, 1), -10 * nu / (1 - nu), 1e-5);
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

TEST_P(FemRegions, WeighWhatTheirDensitiesAre) {
  fem::GridProblem problem = bar(GetParam(), 0, {1e4, 0.3, 1000}, {1e4, 0.3, 3000});
  problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, Gravity{{0, 0, -10}}};
  const fem::Solution s = fem::solve_grid(problem);
  EXPECT_NEAR(s.reactions[0].force[2], 4e4, 1e-3);
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
