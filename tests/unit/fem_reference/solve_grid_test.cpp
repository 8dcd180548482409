// Loads, reactions, supports and points of one solved grid.
#include "fem_reference/solve_grid.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/fem_block.h"

namespace springproof::solve_grid_test {
namespace {

constexpr double balance = 1e-8;  // of the solver's residual 1e-12, relative to the load, times the grid's 1/h

const Vec3 size(2, 1, 1.5);

fem::GridProblem clamped_beam(int degree, double nu) {
  fem::GridProblem problem = test::fem_block(size, {4, 2, 3}, 1, degree, nu);
  problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}};
  if (nu > 0.4) problem.tolerance = 1e-10;  // round-off of the pressure form stops the residual near 1e-11
  return problem;
}

void expect_balance(const fem::GridProblem& problem, const Vec3& force, const Vec3& torque_about_origin) {
  const fem::Solution solution = fem::solve_grid(problem);
  ASSERT_TRUE(solution.ok) << solution.message;
  const test::Wrench reaction = test::total(solution, problem.coarse);
  EXPECT_LE((reaction.force + force).norm(), balance * force.norm()) << reaction.force.transpose();
  EXPECT_LE((reaction.torque + torque_about_origin).norm(), balance * force.norm() * size.norm())
      << reaction.torque.transpose();
}

class FemReactions : public testing::TestWithParam<std::pair<int, double>> {
 protected:
  fem::GridProblem problem = clamped_beam(GetParam().first, GetParam().second);
};

TEST_P(FemReactions, CarryGravity) {
  const Vec3 g(1, -2, -9.81);
  problem.loads.push_back(Gravity{g});
  const Vec3 weight = 1000 * size.prod() * g;
  expect_balance(problem, weight, (size / 2).cross(weight));
}

TEST_P(FemReactions, CarryTractionOnAPatchThatSharesNodesWithTheSupport) {
  const Vec3 t(3, 4, -5);
  problem.loads.push_back(Traction{"z_max", t});
  expect_balance(problem, size[0] * size[1] * t, size[0] * size[1] * Vec3(1, 0.5, 1.5).cross(t));
}

TEST_P(FemReactions, CarryAPatchForce) {
  const Vec3 f(10, -20, 30);
  problem.loads.push_back(PatchForce{"x_max", f});
  problem.place = fem::graded(Vec3::Zero(), size, 1.7);
  expect_balance(problem, f, Vec3(2, 0.5, 0.75).cross(f));
}

TEST_P(FemReactions, CarryAPointForceInsideACell) {
  const Vec3 at(1.13, 0.41, 0.77), f(1, 2, 3);
  problem.loads.push_back(PointForce{at, f});
  expect_balance(problem, f, at.cross(f));
}

TEST_P(FemReactions, CarryTheWrenchThatLoadsCarry) {
  const Wrench w{{1, -2, 3}, {0.2, 0.1, -0.4}, {0.5, 0.2, 1.1}};
  const Vec3 about_origin = w.moment + w.about.cross(w.force);
  for (const Load& load : {Load(Traction{"z_max", {1, 2, 3}, w}), Load(Pressure{"y_max", 5, w}),
                           Load(PatchForce{"x_max", {1, -2, 3}, w}), Load(Gravity{{0, 0, -1e-3}, w})}) {
    fem::GridProblem loaded = problem;
    loaded.loads.push_back(load);
    expect_balance(loaded, w.force, about_origin);
  }
}

INSTANTIATE_TEST_SUITE_P(Forms, FemReactions,
                         testing::Values(std::pair(1, -0.4), std::pair(2, 0.3), std::pair(1, 0.499),
                                         std::pair(2, 0.499)));

// A bar between lubricated plates is under uniaxial stress: exact for every element.
class FemSlipPlates : public testing::TestWithParam<std::pair<int, double>> {};

TEST_P(FemSlipPlates, GiveBackYoungsModulusAndPoissonsRatio) {
  const auto [degree, nu] = GetParam();
  fem::GridProblem problem = test::fem_block(size, {2, 2, 2}, 1, degree, nu);
  problem.tolerance = 1e-13;
  const std::optional<double> is_free;
  const double strain = -0.01;
  problem.loads = {PrescribedDisplacement{"x_min", {0.0, is_free, is_free}},
                   PrescribedDisplacement{"y_min", {is_free, 0.0, is_free}},
                   PrescribedDisplacement{"z_min", {is_free, is_free, 0.0}},
                   PrescribedDisplacement{"z_max", {is_free, is_free, strain * size[2]}}};
  problem.points = size.transpose();
  const fem::Solution solution = fem::solve_grid(problem);
  ASSERT_TRUE(solution.ok) << solution.message;
  const double stress = solution.reactions[3].force[2] / (size[0] * size[1]);
  EXPECT_NEAR(stress / strain / 1e4, 1, 1e-9);
  EXPECT_NEAR(-solution.displacement(0, 0) / size[0] / strain, nu, 1e-9);
  EXPECT_NEAR(-solution.displacement(0, 1) / size[1] / strain, nu, 1e-9);
  EXPECT_NEAR(solution.volume_change_first_order, (1 - 2 * nu) * strain, 1e-11);
}

std::vector<std::pair<int, double>> slip_cases() {
  std::vector<std::pair<int, double>> cases;
  for (int degree : {1, 2})
    for (double nu : {-0.9, -0.5, 0.0, 0.25, 0.4, 0.45, 0.499, 0.4999}) cases.emplace_back(degree, nu);
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Ratios, FemSlipPlates, testing::ValuesIn(slip_cases()));

TEST(FemSolveGrid, TwistsLinearly) {
  // Both ends turned alike: a rigid motion to first order, without stress.
  fem::GridProblem problem = test::fem_block(size, {2, 2, 2}, 0, 1, 0.3);
  const PrescribedRotation turn{"x_min", Vec3(0.3, 0.2, 0.1), Vec3(1, 2, 2) / 3, 0.1};
  PrescribedRotation other = turn;
  other.on = "x_max";
  problem.loads = {turn, other};
  problem.points = test::points_inside(size, 20);
  const fem::Solution solution = fem::solve_grid(problem);
  for (Eigen::Index i = 0; i < problem.points.rows(); ++i) {
    const Vec3 arm = problem.points.row(i).transpose() - turn.point;
    EXPECT_LE((solution.displacement.row(i).transpose() - 0.1 * turn.axis.cross(arm)).norm(), 1e-10);
  }
  EXPECT_LE(solution.reactions[0].force.norm(), 1e-6);
}

TEST(FemSolveGrid, WideVectorsChangeNothing) {
  for (double nu : {0.25, 0.499})
    for (int degree : {1, 2}) {
      fem::GridProblem problem = clamped_beam(degree, nu);
      problem.loads.push_back(Gravity{Vec3(0, 0, -9.81)});
      problem.place = test::shaken_inside(size, 0.03);
      problem.points = test::points_inside(size, 50);
      const NodalVectors wide = fem::solve_grid(problem).displacement;
      problem.wide_vectors = false;
      const NodalVectors narrow = fem::solve_grid(problem).displacement;
      EXPECT_LE((wide - narrow).norm(), 1e-9 * wide.norm());
    }
}

std::string input_error(const fem::GridProblem& problem) {
  try {
    fem::solve_grid(problem);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

// The coarsest level of a slender body has thousands of unknowns and needs hundreds of products: it is factored.
TEST(FemSolveGrid, ASlenderGridOfOneLevelIsSolvedDirectly) {
  fem::GridProblem problem = test::fem_block({2.4, 0.4, 0.4}, {13, 2, 2}, 0, 2, 0.25);
  problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, Gravity{{0, 0, -10}}};
  problem.tolerance = 1e-8;
  const fem::Solution solution = fem::solve_grid(problem);
  ASSERT_TRUE(solution.ok) << solution.message;
  EXPECT_GT(solution.degrees_of_freedom, 1500);
  EXPECT_LE(solution.iterations, 3);  // the factors are of the matrix in single precision
}

// Linear elements lock in a strip of one layer of tetrahedra: a cycle with them below the quadratic ones does nothing
// for its bending.
TEST(FemSolveGrid, AStripOneTetrahedronThickIsSolvedAtSmallAndAtLargeStrain) {
  const Vec3 strip(40, 10, 0.2);
  for (const auto& [law, cells] : {std::pair<const char*, Cells>{"linear", {40, 10, 1}}, {"hencky", {12, 3, 1}}}) {
    fem::GridProblem problem = test::fem_block(strip, cells, 0, 2, 0.45);
    problem.coarse = test::tetrahedra_block(problem.coarse);
    problem.law = law;
    problem.tolerance = 1e-8;
    const double pressure = 1e-5;  // the end moves by two thicknesses
    problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, Traction{"z_max", {0, 0, -pressure}}};
    problem.points = NodalVectors(1, 3);
    problem.points.row(0) << 39.9, 5, 0.1;
    const fem::Solution solution = fem::solve_grid(problem);
    ASSERT_TRUE(solution.ok) << law << ": " << solution.message;
    const double beam = pressure * std::pow(strip[0], 4) / (8 * 1e4 / 12 * std::pow(strip[2], 3));
    EXPECT_LT(-solution.displacement(0, 2), beam) << law;
    EXPECT_GT(-solution.displacement(0, 2), beam * (1 - 0.45 * 0.45)) << law;  // as a plate that keeps its width
  }
}

TEST(FemSolveGrid, RefusesWhatCannotBeSolved) {
  const std::optional<double> is_free;
  fem::GridProblem problem = test::fem_block(size, {2, 2, 2}, 0, 1, 0.3);
  EXPECT_NE(input_error(problem).find("not held anywhere"), std::string::npos);
  problem.loads = {PrescribedDisplacement{"z_min", {is_free, is_free, 0.0}}};
  EXPECT_NE(input_error(problem).find("not held"), std::string::npos);
  problem.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}};
  EXPECT_EQ(input_error(problem), "no error");
  problem.loads.push_back(PrescribedDisplacement{"x_min", {0.1, is_free, is_free}});
  EXPECT_NE(input_error(problem).find("different x-displacements"), std::string::npos);
  problem.loads.back() = Traction{"top", Vec3::UnitX()};
  EXPECT_NE(input_error(problem).find("z_max"), std::string::npos);
  problem.loads.pop_back();
  problem.law = "rubber";
  EXPECT_NE(input_error(problem).find("hencky"), std::string::npos);
  problem.law = "linear";
  problem.points = Vec3(100, 0, 0).transpose();
  EXPECT_NE(input_error(problem).find("outside"), std::string::npos);
}

}  // namespace
}  // namespace springproof::solve_grid_test
