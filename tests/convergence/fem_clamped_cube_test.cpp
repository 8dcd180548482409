// The clamped cube squeezed by 5 %: energies computed independently (dolfinx, CalculiX and another deal.II
// program).
#include <gtest/gtest.h>

#include "support/fem_block.h"

namespace springproof::fem_clamped_cube_test {
namespace {

// Elastic energy from the force on the moved face, F = 2 W / displacement.
double energy(int degree, double nu, int cells, double grading = 1) {
  const Vec3 size(5, 5, 5);
  const bool halves = cells % 2 == 0;
  const int coarse = halves ? cells / 2 : cells;
  fem::GridProblem problem = test::fem_block(size, {coarse, coarse, coarse}, halves, degree, nu);
  problem.tolerance = 1e-10;
  problem.place = fem::graded(Vec3::Zero(), size, grading);
  problem.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                   PrescribedDisplacement{"z_max", {0.0, 0.0, -0.25}}};
  const fem::Solution solution = fem::solve_grid(problem);
  EXPECT_TRUE(solution.ok) << solution.message;
  return -0.25 * solution.reactions[1].force[2] / 2;
}

TEST(FemClampedCube, ConvergesToTheKnownEnergy) {
  // 1629.15 J is the extrapolation of full-integration Q1 and Q2 sequences; the corner singularity leaves
  // 0.05 J.
  EXPECT_NEAR(energy(2, 0.25, 20, 1.5), 1629.15, 0.1);
}

TEST(FemClampedCube, MeanDilatationAndPressureKnownOnCoarseGrids) {
  // Condensed B-bar, computed by assembly; printed to five digits.
  EXPECT_NEAR(energy(1, 0.4999, 8), 1975.5, 0.05);
  EXPECT_NEAR(energy(1, 0.4999, 16), 1949.0, 0.05);
  EXPECT_NEAR(energy(2, 0.4999, 4), 1947.9, 0.05);
  EXPECT_NEAR(energy(2, 0.4999, 8), 1934.4, 0.05);
}

TEST(FemClampedCube, DoesNotLock) {
  const double fine = energy(2, 0.4999, 16, 1.5);
  EXPECT_NEAR(energy(1, 0.4999, 10) / fine, 1, 0.025);  // full integration is 17 times too stiff here
  EXPECT_NEAR(energy(2, 0.4999, 5) / fine, 1, 0.01);
}

TEST(FemClampedCube, FormsMeetWherePressureBecomesAnUnknown) {
  // B-bar by averaging at 0.4995 and by an unknown pressure just above are one discretisation.
  const double below = energy(1, 0.4995, 6), above = energy(1, 0.4995 + 1e-12, 6);
  EXPECT_NEAR(above / below, 1, 1e-8);
}

}  // namespace
}  // namespace springproof::fem_clamped_cube_test
