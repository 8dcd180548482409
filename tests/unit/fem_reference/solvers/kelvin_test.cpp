// A point force in a block whose surface is held as Kelvin's solution says: inside, Kelvin's solution again.
#include <gtest/gtest.h>

#include "problem/kelvin.h"
#include "support/fem_block.h"

namespace springproof::kelvin_test {
namespace {

const Vec3 size(1, 1.2, 0.9), middle = size / 2;

fem::GridProblem held_by_kelvin(const KelvinSolution& exact, int refinements) {
  fem::GridProblem problem = test::fem_block(size, {3, 3, 3}, refinements, 2, exact.material.poisson_ratio);
  problem.material = exact.material;
  problem.loads = {PointForce{exact.at, exact.force}};
  for (const std::string& face : test::block_faces) problem.loads.push_back(PrescribedField{face, "kelvin", exact});
  return problem;
}

/// Points at least 0.2 m from the force.
NodalVectors points_away_from_the_force() {
  const NodalVectors all = test::points_inside(size, 200);
  NodalVectors away(0, 3);
  for (const auto& X : all.rowwise())
    if ((X.transpose() - middle).norm() > 0.2) {
      away.conservativeResize(away.rows() + 1, 3);
      away.bottomRows(1) = X;
    }
  return away;
}

double error(const KelvinSolution& exact, int refinements) {
  fem::GridProblem problem = held_by_kelvin(exact, refinements);
  problem.points = points_away_from_the_force();
  const fem::Solution s = fem::solve_grid(problem);
  EXPECT_TRUE(s.ok) << s.message;
  NodalVectors truth = problem.points;
  for (auto X : truth.rowwise()) X = kelvin_displacement(exact, X.transpose()).transpose();
  return (s.displacement - truth).norm() / truth.norm();
}

TEST(FemKelvin, DisplacementAwayFromTheForceIsKelvins) {
  const KelvinSolution exact{{3, -2, 5}, middle, {1e4, 0.3, 1000}};
  const double coarse = error(exact, 2), fine = error(exact, 3);
  EXPECT_LT(fine, 3e-3);
  EXPECT_LT(fine, coarse / 3);
}

/// The reactions are the tractions of a stress whose resultant balances the force.
TEST(FemKelvin, TheSurfaceBearsTheForce) {
  const KelvinSolution exact{{3, -2, 5}, middle, {1e4, 0.3, 1000}};
  const fem::GridProblem problem = held_by_kelvin(exact, 1);
  const test::Wrench wrench = test::total(fem::solve_grid(problem), problem.coarse);
  EXPECT_LT((wrench.force + exact.force).norm(), 1e-8 * exact.force.norm());
}

}  // namespace
}  // namespace springproof::kelvin_test
