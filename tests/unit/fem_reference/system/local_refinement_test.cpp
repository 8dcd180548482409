// Tetrahedra cut where the error is largest.
#include <gtest/gtest.h>

#include "fem_reference/solve_grid.h"
#include "meshes/volume.h"
#include "support/fem_block.h"

namespace springproof::local_refinement_test {
namespace {

using namespace test;

/// Held on half of a face, pushed at the opposite one: stresses at the rim grow as 1/sqrt(r).
fem::GridProblem held_on_half(int cells) {
  fem::GridProblem problem;
  problem.coarse = tetrahedra_block(block_mesh({1, 1, 0.5}, {2 * cells, 2 * cells, cells}));
  for (Patch& p : problem.coarse.patches)
    if (p.name == "z_min")
      std::erase_if(p.facets, [&](const auto& f) {
        return problem.coarse.nodes(f[0], 0) + problem.coarse.nodes(f[1], 0) + problem.coarse.nodes(f[2], 0) > 1.5;
      });
  problem.material = {1e4, 0.3, 1000};
  problem.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}, PatchForce{"z_max", {1, 0, 1}}};
  problem.points = NodalVectors(1, 3);
  problem.points << 1, 1, 0.5;
  return problem;
}

Vec3 corner(const fem::GridProblem& problem) {
  const fem::Solution s = fem::solve_grid(problem);
  EXPECT_TRUE(s.ok) << s.message;
  return s.displacement.row(0).transpose();
}

TEST(LocalRefinement, FindsTheRimOfASupport) {
  fem::GridProblem cut = held_on_half(3), best = held_on_half(3);
  best.coarse = fem::refined_locally(best, 30);
  const Vec3 truth = corner(best);
  cut.coarse = fem::refined_locally(cut, 6);
  const fem::GridProblem even = held_on_half(6);  // 8 times as many cells
  ASSERT_LT(cut.coarse.tetrahedra.size(), even.coarse.tetrahedra.size());
  EXPECT_LT((corner(cut) - truth).norm(), 0.6 * (corner(even) - truth).norm());
}

TEST(LocalRefinement, KeepsTheBodyItsPatchesAndItsMaterials) {
  fem::GridProblem problem = held_on_half(2);
  problem.regions = {{1e6, 0.3, 1000}};
  const Mesh before = problem.coarse;
  for (const Tetrahedron& t : before.tetrahedra) {
    double y = 0;
    for (const int n : t) y += before.nodes(n, 1) / 4;
    problem.coarse.materials.push_back(y > 0.5);
  }
  const Mesh after = fem::refined_locally(problem, 3);
  EXPECT_GE(after.tetrahedra.size(), 3 * before.tetrahedra.size());
  ASSERT_EQ(after.materials.size(), after.tetrahedra.size());
  EXPECT_NEAR(volume(after, after.nodes), 0.5, 1e-12);
  double beyond = 0;
  const Eigen::VectorXd volumes = cell_volumes(after, after.nodes);
  for (std::size_t c = 0; c < after.materials.size(); ++c) beyond += after.materials[c] * volumes[Eigen::Index(c)];
  EXPECT_NEAR(beyond, 0.25, 1e-12);
  for (const auto& [name, share] : {std::pair("z_min", 0.5), std::pair("z_max", 1.0)})
    EXPECT_NEAR(nodal_areas(after, patch(after, name)).sum(), share, 1e-12) << name;
}

/// Displacements under a point force have no limit: cuts there end, and the other cells have their turn.
TEST(LocalRefinement, UnderAPointForceEnds) {
  fem::GridProblem problem = held_on_half(2);
  problem.loads.push_back(PointForce{{0.71, 0.42, 0.27}, {0, 0, 100}});
  const Mesh after = fem::refined_locally(problem, 10);
  EXPECT_GE(after.tetrahedra.size(), 10 * problem.coarse.tetrahedra.size());
  double shortest = 1;
  for (const Tetrahedron& t : after.tetrahedra)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) shortest = std::min(shortest, (after.nodes.row(t[i]) - after.nodes.row(t[j])).norm());
  EXPECT_GT(shortest, 0.25 / 64 / 4);
}

TEST(LocalRefinement, LeavesOtherElementsAsTheyAre) {
  fem::GridProblem problem = held_on_half(2);
  problem.degree = 1;
  EXPECT_EQ(fem::refined_locally(problem, 3).tetrahedra, problem.coarse.tetrahedra);
}

}  // namespace
}  // namespace springproof::local_refinement_test
