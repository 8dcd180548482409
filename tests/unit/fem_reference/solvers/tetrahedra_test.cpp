// Quadratic tetrahedra without matrices: the numbers of those with, and few iterations on bodies with thin parts and
// slivers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fem_reference/solve_grid.h"
#include "meshes/mesher/mesher.h"
#include "support/fem_block.h"

namespace springproof::tetrahedra_test {
namespace {

/// A cube of tetrahedra, those around its centre flat.
Mesh cube_with_slivers() {
  Mesh mesh = test::tetrahedra_block(test::fem_block(Vec3(1, 1, 1), {4, 4, 4}, 0, 2, 0.3).coarse);
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n)
    if ((mesh.nodes.row(n) - Eigen::RowVector3d(0.5, 0.5, 0.5)).norm() < 1e-9) mesh.nodes(n, 0) += 0.2495;
  return mesh;
}

class MatrixFreeTetrahedra : public testing::TestWithParam<double> {};

TEST_P(MatrixFreeTetrahedra, FindWhatMatricesFind) {
  fem::GridProblem problem = test::fem_block(Vec3(1, 1, 1), {4, 4, 4}, 0, 2, GetParam());
  problem.coarse = cube_with_slivers();
  problem.tolerance = 1e-10;
  problem.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}, PrescribedDisplacement{"z_max", {0.1, {}, -0.1}},
                   Gravity{{0, 1, 0}}, Pressure{"x_max", 50}};
  problem.points = problem.stress_points = test::points_inside(Vec3(1, 1, 1), 20);
  problem.method = fem::Method::assembled;
  const fem::Solution expected = fem::solve_grid(problem);
  ASSERT_TRUE(expected.ok) << expected.message;
  problem.method = fem::Method::automatic;
  for (const bool wide : {false, true}) {
    problem.wide_vectors = wide;
    const fem::Solution found = fem::solve_grid(problem);
    ASSERT_TRUE(found.ok) << found.message;
    EXPECT_NE(found.form.find("matrix-free"), std::string::npos) << found.form;
    EXPECT_LE((found.displacement - expected.displacement).norm(), 1e-7 * expected.displacement.norm());
    EXPECT_LE((found.stress - expected.stress).norm(), 1e-6 * expected.stress.norm());
    EXPECT_LE((found.reactions[1].force - expected.reactions[1].force).norm(),
              1e-7 * expected.reactions[1].force.norm());
    EXPECT_NEAR(found.volume_change, expected.volume_change, 1e-8);
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, MatrixFreeTetrahedra, testing::Values(-0.5, 0.3, 0.4999),
                         [](const auto& instance) { return fmt::format("nu{:05.0f}", 1e4 * (1 + instance.param)); });

struct RaggedBody {
  std::string name;
  Vec3 size;
  std::string held, pulled;
};

class RaggedBodies : public testing::TestWithParam<RaggedBody> {};

// Parts of one cell's thickness, tetrahedra of 3 r/R = 0.1: as the references of bodies have them.
TEST_P(RaggedBodies, TakeFewIterationsNearOneHalf) {
  const RaggedBody& body = GetParam();
  fem::GridProblem problem;
  problem.coarse =
      mesh_body(
          {.file = find_geo({body.name + ".geo", {}, {}, {}}, "case.toml"), .size = body.size, .tetrahedra = 3000})
          .mesh;
  problem.loads = {PrescribedDisplacement{body.held, {0.0, 0.0, 0.0}}, PatchForce{body.pulled, {-0.1, 0, 0}}};
  problem.points = NodalVectors(0, 3);
  problem.tolerance = 1e-8;
  for (const double nu : {0.45, 0.4999}) {
    problem.material = {1e4, nu, 1000};
    const fem::Solution s = fem::solve_grid(problem);
    EXPECT_TRUE(s.ok) << s.message;
    EXPECT_LE(s.iterations, 60) << s.form << ", nu = " << nu;
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, RaggedBodies,
                         testing::Values(RaggedBody{"rabbit", {0.2, 0.12, 0.25}, "feet", "head"},
                                         RaggedBody{"hand", {0.137, 0.035, 0.188}, "wrist", "middle"}),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace springproof::tetrahedra_test
