// Patch test of the elements: a non-symmetric affine displacement on the whole surface must be met inside, on
// straight and on distorted cells, with and without a multigrid hierarchy, in every form.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/fem_block.h"
#include "support/tolerances.h"

namespace springproof::fem_patch_test {
namespace {

struct PatchCase {
  int degree;
  double poisson_ratio;
  bool distorted;
};

class FemPatchTest : public testing::TestWithParam<PatchCase> {};

TEST_P(FemPatchTest, AffineFieldIsExactInside) {
  const auto [degree, nu, distorted] = GetParam();
  const Vec3 size(1.5, 1.0, 2.0);
  fem::GridProblem problem = test::fem_block(size, {3, 2, 4}, 1, degree, nu);
  problem.tolerance = 1e-13;
  if (distorted) problem.place = test::shaken_inside(size, 0.05);
  Eigen::Matrix3d gradient;
  gradient << 1e-3, 2e-3, -0.5e-3, -1.5e-3, 0.7e-3, 0.3e-3, 0.9e-3, -1.1e-3, -0.6e-3;
  const Vec3 offset(0.01, -0.02, 0.03);
  for (const std::string& face : test::block_faces) problem.loads.push_back(PrescribedAffine{face, gradient, offset});
  problem.points = test::points_inside(size, 200);

  const fem::Solution solution = fem::solve_grid(problem);
  ASSERT_TRUE(solution.ok) << solution.message;
  const NodalVectors exact = (problem.points * gradient.transpose()).rowwise() + offset.transpose();
  // The offset is rigid: measure against the part that strains.
  const double strained = (problem.points * gradient.transpose()).norm();
  EXPECT_LE((solution.displacement - exact).norm() / strained, test::patch_test);
  EXPECT_NEAR(solution.volume_change_first_order, gradient.trace(), 1e-3 * test::patch_test);
  EXPECT_NEAR(solution.volume_change, (Eigen::Matrix3d::Identity() + gradient).determinant() - 1,
              1e-3 * test::patch_test);
}

std::vector<PatchCase> patch_cases() {
  std::vector<PatchCase> cases;
  for (int degree : {1, 2})
    for (double nu : {-0.9, -0.3, 0.0, 0.25, 0.4, 0.45, 0.499, 0.4999})
      for (bool distorted : {false, true}) cases.push_back({degree, nu, distorted});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Elements, FemPatchTest, testing::ValuesIn(patch_cases()), [](const auto& instance) {
  return fmt::format("Q{}_{}_{}{:04.0f}", instance.param.degree, instance.param.distorted ? "distorted" : "straight",
                     instance.param.poisson_ratio < 0 ? "minus_" : "", 1e4 * std::abs(instance.param.poisson_ratio));
});

}  // namespace
}  // namespace springproof::fem_patch_test
