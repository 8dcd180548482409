// Bodies of many cubes: linear elements below the coarsest level of the matrix-free multigrid; points in tetrahedra.
#include <gtest/gtest.h>

#include <random>

#include "fem_reference/solve_grid.h"
#include "support/fem_block.h"

namespace springproof::voxel_body_test {
namespace {

/// An L of cubes, 1,300 of them, held at one end.
Mesh bracket() {
  const Mesh block = block_mesh({1, 1, 0.5}, {16, 16, 8});
  Mesh mesh = block;
  mesh.hexahedra.clear();
  std::vector<int> number(block.nodes.rows(), -1);
  for (const Hexahedron& cell : block.hexahedra) {
    const Vec3 low = block.nodes.row(cell[0]).transpose();
    if (low[0] < 0.4 || low[1] < 0.4) mesh.hexahedra.push_back(cell);
  }
  int nodes = 0;
  for (Hexahedron& cell : mesh.hexahedra)
    for (int& n : cell) {
      if (number[n] < 0) {
        mesh.nodes.row(nodes) = block.nodes.row(n);
        number[n] = nodes++;
      }
      n = number[n];
    }
  mesh.nodes.conservativeResize(nodes, 3);
  for (Patch& patch : mesh.patches) {
    std::vector<std::array<int, 4>> kept;
    for (auto facet : patch.facets) {
      for (int& n : facet) n = number[n];
      if (*std::min_element(facet.begin(), facet.end()) >= 0) kept.push_back(facet);
    }
    patch.facets = kept;
  }
  mesh.grid = detect_grid(mesh);
  return mesh;
}

fem::GridProblem problem_of(int degree, double nu) {
  fem::GridProblem problem;
  problem.coarse = bracket();
  problem.degree = degree;
  problem.material = {1e4, nu, 1000};
  problem.loads = {PrescribedDisplacement{"y_max", {0.0, 0.0, 0.0}}, PatchForce{"x_max", {0, 0, 10}}};
  problem.points = problem.coarse.nodes;
  problem.tolerance = 1e-9;
  return problem;
}

class ManyCubes : public testing::TestWithParam<std::pair<int, double>> {};

TEST_P(ManyCubes, MatrixFreeAndAssembledAgree) {
  fem::GridProblem problem = problem_of(GetParam().first, GetParam().second);
  const fem::Solution free = fem::solve_grid(problem);
  ASSERT_TRUE(free.ok) << free.message;
  EXPECT_NE(free.form.find("matrix-free"), std::string::npos) << free.form;
  problem.method = fem::Method::assembled;
  const fem::Solution assembled = fem::solve_grid(problem);
  ASSERT_TRUE(assembled.ok) << assembled.message;
  EXPECT_NE(assembled.form.find("algebraic"), std::string::npos) << assembled.form;
  EXPECT_LT((free.displacement - assembled.displacement).norm(), 1e-6 * assembled.displacement.norm());
  EXPECT_LT(free.iterations, GetParam().second > 0.4 ? 200 : 60);
}

INSTANTIATE_TEST_SUITE_P(Elements, ManyCubes,
                         testing::Values(std::pair(1, 0.3), std::pair(2, -0.5), std::pair(2, 0.499)));

TEST(ManyCubesRefined, ConvergeInAsManySteps) {
  fem::GridProblem problem = problem_of(2, 0.3);
  const int coarse = fem::solve_grid(problem).iterations;
  problem.refinements = 1;
  const fem::Solution fine = fem::solve_grid(problem);
  ASSERT_TRUE(fine.ok) << fine.message;
  EXPECT_LE(fine.iterations, coarse + 10);
}

TEST(PointsInTetrahedra, TakeLinearFieldsExactly) {
  Eigen::Matrix3d H;
  H << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  H *= 1e-3;
  fem::GridProblem problem;
  const Mesh block = block_mesh({1, 1, 1}, {3, 3, 3});
  problem.coarse.nodes = block.nodes;
  constexpr int cut[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  for (const Hexahedron& cell : block.hexahedra)
    for (const auto& t : cut) problem.coarse.tetrahedra.push_back({cell[t[0]], cell[t[1]], cell[t[2]], cell[t[3]]});
  for (const Patch& p : block.patches) {
    problem.coarse.patches.push_back({p.name, {}});
    for (const auto& f : p.facets)  // the diagonal through the cell's corner 0 or 6
      for (const auto& t : {std::array{0, 1, 2}, {0, 2, 3}, {1, 2, 3}, {1, 3, 0}})
        problem.coarse.patches.back().facets.push_back({f[t[0]], f[t[1]], f[t[2]], -1});
    problem.loads.push_back(PrescribedAffine{p.name, H, Vec3::Zero()});
  }
  problem.degree = 2;
  problem.material = {1e4, 0.3, 1000};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(-0.01, 1.01);  // some outside
  problem.points.resize(200, 3);
  for (double& value : problem.points.reshaped()) value = x(random);
  const fem::Solution s = fem::solve_grid(problem);
  ASSERT_TRUE(s.ok) << s.message;
  EXPECT_LT((s.displacement - problem.points * H.transpose()).cwiseAbs().maxCoeff(), 1e-8 * 0.03);
  problem.points.row(0) << 1.5, 0.5, 0.5;
  EXPECT_THROW(fem::solve_grid(problem), InputError);
}

}  // namespace
}  // namespace springproof::voxel_body_test
