// Finite strain: closed forms under uniform strain, invariance, balance, and numbers of an independent
// program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/fem_block.h"
#include "support/tolerances.h"
#include "support/uniaxial.h"

namespace springproof::finite_strain_test {
namespace {

const std::vector<std::string> all_laws = {"hencky", "log_cauchy", "neo_hooke", "neo_hooke_isochoric",
                                           "st_venant_kirchhoff"};
const Vec3 size(2, 1, 1.5);
const std::optional<double> is_free;

struct BarCase {
  std::string law;
  int degree;
  double poisson_ratio;
};

class FemFiniteBar : public testing::TestWithParam<BarCase> {};

TEST_P(FemFiniteBar, FollowsTheClosedForm) {
  const auto& [law, degree, nu] = GetParam();
  for (double stretch : {0.8, 1.2}) {
    fem::GridProblem problem = test::fem_block(size, {2, 2, 2}, 0, degree, nu);
    problem.law = law;
    problem.place = test::shaken_inside(size, 0.05);
    problem.loads = {PrescribedDisplacement{"x_min", {0.0, is_free, is_free}},
                     PrescribedDisplacement{"y_min", {is_free, 0.0, is_free}},
                     PrescribedDisplacement{"z_min", {is_free, is_free, 0.0}},
                     PrescribedDisplacement{"z_max", {is_free, is_free, (stretch - 1) * size[2]}}};
    problem.points = size.transpose();
    const fem::Solution solution = fem::solve_grid(problem);
    ASSERT_TRUE(solution.ok) << solution.message;
    const auto [lateral, stress] = test::uniaxial(law, problem.material, stretch);
    EXPECT_NEAR(1 + solution.displacement(0, 0) / size[0], lateral, 1e-9);
    EXPECT_NEAR(solution.reactions[3].force[2] / (size[0] * size[1]) / stress, 1, 1e-8);
    EXPECT_NEAR(solution.volume_change, stretch * lateral * lateral - 1, 1e-9);
  }
}

std::vector<BarCase> bar_cases() {
  std::vector<BarCase> cases;
  for (const std::string& law : all_laws)
    for (int degree : {1, 2})
      for (double nu : {-0.5, 0.0, 0.3, 0.499}) cases.push_back({law, degree, nu});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Laws, FemFiniteBar, testing::ValuesIn(bar_cases()), [](const auto& instance) {
  return fmt::format("{}_Q{}_{}", instance.param.law, instance.param.degree, instance.index);
});

class FemFinite : public testing::TestWithParam<std::string> {
 protected:
  fem::GridProblem clamped(const Vec3& lid, int degree, double nu, const Cells& cells = {4, 4, 4}) {
    fem::GridProblem problem = test::fem_block(Vec3(5, 5, 5), cells, 1, degree, nu);
    problem.law = GetParam();
    problem.tolerance = 1e-10;
    problem.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                     PrescribedDisplacement{"z_max", {lid[0], lid[1], lid[2]}}};
    return problem;
  }
};

TEST_P(FemFinite, AffineFieldIsExactInside) {
  Eigen::Matrix3d gradient;
  gradient << 0.1, 0.2, -0.05, -0.15, 0.07, 0.03, 0.09, -0.11, -0.06;
  for (int degree : {1, 2})
    for (double nu : {0.3, 0.49}) {
      fem::GridProblem problem = test::fem_block(size, {3, 2, 2}, 1, degree, nu);
      problem.law = GetParam();
      problem.place = test::shaken_inside(size, 0.03);
      for (const std::string& face : test::block_faces)
        problem.loads.push_back(PrescribedAffine{face, gradient, Vec3(1, 2, 3)});
      problem.points = test::points_inside(size, 50);
      const fem::Solution solution = fem::solve_grid(problem);
      ASSERT_TRUE(solution.ok) << solution.message;
      const NodalVectors exact = (problem.points * gradient.transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3);
      EXPECT_LE((solution.displacement - exact).norm(), test::patch_test * exact.norm());
    }
}

TEST_P(FemFinite, FeelsNothingWhenTurnedAsAWhole) {
  fem::GridProblem problem = test::fem_block(size, {2, 2, 2}, 0, 1, 0.3);
  problem.law = GetParam();
  PrescribedRotation turn{"x_min", Vec3(0.3, 0.2, 0.1), Vec3(1, 2, 2) / 3, 1.5};
  problem.loads = {turn};
  turn.on = "x_max";
  problem.loads.push_back(turn);
  problem.points = test::points_inside(size, 20);
  const fem::Solution solution = fem::solve_grid(problem);
  ASSERT_TRUE(solution.ok) << solution.message;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(1.5, turn.axis).toRotationMatrix();
  for (Eigen::Index i = 0; i < problem.points.rows(); ++i) {
    const Vec3 arm = problem.points.row(i).transpose() - turn.point;
    EXPECT_LE((solution.displacement.row(i).transpose() - (R * arm - arm)).norm(), 1e-8);
  }
  EXPECT_LE(solution.reactions[0].force.norm(), 1e-4);  // of E A = 1e4 N
  EXPECT_NEAR(solution.volume_change, 0, 1e-9);
}

TEST_P(FemFinite, IsLinearForSmallLoads) {
  for (double nu : {0.25, 0.49}) {
    fem::GridProblem problem = clamped(Vec3(3e-6, 0, -5e-6), 2, nu, {2, 2, 2});
    const fem::Solution finite = fem::solve_grid(problem);
    problem.law = "linear";
    const fem::Solution linear = fem::solve_grid(problem);
    ASSERT_TRUE(finite.ok && linear.ok);
    const Vec3 force = linear.reactions[1].force;
    EXPECT_LE((finite.reactions[1].force - force).norm(), 2e-5 * force.norm());
  }
}

TEST_P(FemFinite, SupportsBalanceOneAnother) {
  for (int degree : {1, 2}) {
    const fem::GridProblem problem = clamped(Vec3(0.7, 0.4, -0.5), degree, 0.3, {2, 2, 2});
    const fem::Solution solution = fem::solve_grid(problem);
    ASSERT_TRUE(solution.ok) << solution.message;
    const double scale = solution.reactions[0].force.norm();
    const test::Wrench sum = test::total(solution, problem.coarse);
    EXPECT_LE(sum.force.norm(), 1e-8 * scale);
    EXPECT_LE(sum.torque.norm(),
              1e-7 * scale);  // arms of the deformed body: with those at rest it is 0.4 scale
  }
}

TEST_P(FemFinite, CarriesDeadWeight) {
  fem::GridProblem problem = test::fem_block(Vec3(2.4, 0.4, 0.4), {6, 1, 1}, 1, 2, 0.3);
  problem.law = GetParam();
  problem.tolerance = 1e-10;
  problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, Gravity{Vec3(0, 0, -0.03)}};
  problem.points = Eigen::RowVector3d(2.4, 0.2, 0.2);
  const fem::Solution solution = fem::solve_grid(problem);
  ASSERT_TRUE(solution.ok) << solution.message;
  const double weight = 1000 * 0.03 * 2.4 * 0.4 * 0.4;
  EXPECT_NEAR(solution.reactions[0].force[2] / weight, 1, 1e-8);
  EXPECT_LT(solution.displacement(0, 2), -0.5);  // far beyond small deflections: the tip comes back
  EXPECT_LT(solution.displacement(0, 0), -0.1);
}

TEST_P(FemFinite, SaysHowFarItCame) {
  fem::GridProblem problem = clamped(Vec3(0, 0, -5.5), 1, 0.3, {1, 1, 1});  // the lid below the floor
  const fem::Solution solution = fem::solve_grid(problem);
  EXPECT_FALSE(solution.ok);
  EXPECT_NE(solution.message.find("% of the load"), std::string::npos) << solution.message;
  EXPECT_GT(solution.min_jacobian, 0);
}

INSTANTIATE_TEST_SUITE_P(Laws, FemFinite, testing::ValuesIn(all_laws));

// Q2 on 8^3 cells, nu = 0.25, E = 1e4, cube of 5 m: another deal.II program (assembled tangent, algebraic
// multigrid).
TEST(FemFiniteClampedCube, AgreesWithAnotherProgram) {
  fem::GridProblem problem = test::fem_block(Vec3(5, 5, 5), {4, 4, 4}, 1, 2, 0.25);
  problem.tolerance = 1e-9;
  const auto solve = [&](const std::string& law, const Vec3& lid) {
    problem.law = law;
    problem.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                     PrescribedDisplacement{"z_max", {lid[0], lid[1], lid[2]}}};
    return fem::solve_grid(problem);
  };
  EXPECT_NEAR(solve("hencky", Vec3(0, 0, -1)).volume_change, -0.1261, 1e-4);
  EXPECT_NEAR(solve("neo_hooke", Vec3(0, 0, -1)).volume_change, -0.1260, 1e-4);
  EXPECT_NEAR(solve("neo_hooke", Vec3(0, 0, 1)).volume_change, 0.1174, 1e-4);
  EXPECT_NEAR(solve("hencky", Vec3(1, 0, 0)).reactions[1].force[0], 13024, 1);
}

// Golec et al. (2019), Table 5, LS-Dyna on about 10^3 bricks: 1279 N m and 57981 N m; the angles are 1 and 45
// degrees.
TEST(FemFiniteClampedCube, TwistsAsPublished) {
  fem::GridProblem problem = test::fem_block(Vec3(5, 5, 5), {5, 5, 5}, 1, 1, 0.25);
  problem.law = "hencky";
  for (const auto& [degrees, torque] : {std::pair(1.0, 1279.0), std::pair(45.0, 57981.0)}) {
    problem.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                     PrescribedRotation{"z_max", Vec3(2.5, 2.5, 5), Vec3::UnitZ(), degrees * 3.14159265358979 / 180}};
    const fem::Solution solution = fem::solve_grid(problem);
    ASSERT_TRUE(solution.ok) << solution.message;
    EXPECT_NEAR(solution.reactions[1].torque[2] / torque, 1, 0.03);
  }
}

}  // namespace
}  // namespace springproof::finite_strain_test
