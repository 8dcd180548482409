// Patch test of the models: a non-symmetric affine displacement on the whole surface must be met inside, for every
// spring pattern and Poisson's ratio, by every linear solver; and the moduli must come back from a block.
#include <gtest/gtest.h>

#include "msm/measure/moduli.h"
#include "msm/statics/equilibrium.h"
#include "support/tolerances.h"
#include "support/zoo.h"

namespace springproof::msm_patch_test {
namespace {

Eigen::Matrix3d gradient() {
  Eigen::Matrix3d g;
  g << 1e-3, 2e-3, -0.5e-3, -1.5e-3, 0.7e-3, 0.3e-3, 0.9e-3, -1.1e-3, -0.6e-3;
  return g;
}

std::vector<Load> affine_on_all_faces() {
  std::vector<Load> loads;
  for (const char* face : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    loads.push_back(PrescribedAffine{face, gradient(), Vec3(0.01, -0.02, 0.03)});
  return loads;
}

double patch_error(const ModelParameters& p, double nu, const std::array<int, 3>& cells, LinearSolver solver) {
  const Mesh mesh = block_mesh(0.5 * Vec3(cells[0], cells[1], cells[2]), cells);
  const MassSpringModel model = build_model(p, mesh, {1e4, nu, 1000});
  const BoundaryConditions bc = transfer(affine_on_all_faces(), mesh, 1000, Kinematics::linear);
  const Equilibrium e = solve_linear(model, bc, {solver, 1e-13, 1000});
  EXPECT_TRUE(e.ok) << e.message;
  const NodalVectors exact = (mesh.nodes * gradient().transpose()).rowwise() + Eigen::RowVector3d(0.01, -0.02, 0.03);
  return (e.displacement - exact).norm() / exact.norm();
}

class PatchTest : public testing::TestWithParam<std::string> {};

TEST_P(PatchTest, AffineFieldIsExactInside) {
  ModelParameters p = test::model(GetParam());
  p.exact_volumes = true;  // of eMSM: with w = k L edges and corners answer to shear
  for (double nu : {-0.9, -0.5, 0.0, 0.25, 0.4, 0.45, 0.49, 0.499})
    EXPECT_LE(patch_error(p, nu, {5, 4, 3}, LinearSolver::cholesky), test::patch_test) << "nu = " << nu;
}

INSTANTIATE_TEST_SUITE_P(Models, PatchTest, testing::ValuesIn(test::model_names()),
                         [](const auto& i) { return i.param; });

TEST(PatchTestSolvers, EverySolverAgrees) {
  for (double A : {0.25, 1.0, 2.0, 8.0}) {
    ModelParameters p = test::model("hybmss");
    p.face_to_cube = A;
    for (double nu : {-0.9, 0.0, 0.4})
      EXPECT_LE(patch_error(p, nu, {11, 7, 9}, LinearSolver::multigrid), test::patch_test);
    for (double nu : {0.45, 0.499, 0.4999})
      EXPECT_LE(patch_error(p, nu, {11, 7, 9}, LinearSolver::mixed_multigrid), test::patch_test);
  }
}

class Moduli : public testing::TestWithParam<std::string> {};

TEST_P(Moduli, ComeBackFromABlock) {
  ModelParameters p = test::model(GetParam());
  p.exact_volumes = true;  // of eMSM, as above
  for (double nu : {-0.9, -0.5, 0.0, 0.25, 0.4, 0.49, 0.499}) {
    if (p.has(Extension::none) && nu != 0.25) continue;  // springs alone have nu = 1/4
    const IsotropicMaterial material{1e4, nu, 1000};
    const MeasuredModuli m = measure_moduli(p, material);
    EXPECT_NEAR(m.youngs_modulus / material.youngs_modulus, 1, 1e-8) << "nu = " << nu;
    EXPECT_NEAR(m.poisson_ratio, nu, 1e-8);
    EXPECT_NEAR(m.shear_modulus / shear_modulus(material), 1, test::round_off * 100);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Moduli, testing::ValuesIn(test::model_names()), [](const auto& i) { return i.param; });

TEST(ModuliOfSprings, AreAlwaysThoseOfOneQuarter) {
  const MeasuredModuli m = measure_moduli(test::model("msm_18"), {1e4, 0.4, 1000});
  EXPECT_NEAR(m.youngs_modulus, 1e4, 1e-4);
  EXPECT_NEAR(m.poisson_ratio, 0.25, 1e-8);
}

}  // namespace
}  // namespace springproof::msm_patch_test
