// The solver with matrices: against the one without, on tetrahedra, and its cells against finite differences.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fem_reference/elements/cell_equations.h"
#include "support/fem_block.h"
#include "support/uniaxial.h"

namespace springproof::assembled_test {
namespace {

fem::GridProblem leaning(int degree, double nu, const std::string& law) {
  fem::GridProblem problem = test::fem_block(Vec3(1, 1, 2), {1, 1, 2}, 1, degree, nu);
  problem.law = law;
  problem.tolerance = 1e-10;
  problem.place = test::shaken_inside(Vec3(1, 1, 2), 0.02);
  problem.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}, PrescribedDisplacement{"z_max", {0.1, 0.05, -0.1}},
                   Gravity{{0, 1, 0}}, Pressure{"x_max", 50}};
  problem.points = test::points_inside(Vec3(1, 1, 2), 20);
  problem.stress_points = problem.points;
  return problem;
}

struct BothWays {
  int degree;
  double poisson_ratio;
  std::string law;
};

class Assembled : public testing::TestWithParam<BothWays> {};

TEST_P(Assembled, FindsWhatTheMatrixFreeSolverFinds) {
  const auto& [degree, nu, law] = GetParam();
  fem::GridProblem problem = leaning(degree, nu, law);
  const fem::Solution expected = fem::solve_grid(problem);
  ASSERT_TRUE(expected.ok) << expected.message;
  for (const fem::Method method : {fem::Method::assembled, fem::Method::assembled_gamg}) {
    problem.method = method;
    const fem::Solution found = fem::solve_grid(problem);
    ASSERT_TRUE(found.ok) << found.message;
    EXPECT_NE(found.form.find("algebraic"), std::string::npos) << found.form;
    EXPECT_LE((found.displacement - expected.displacement).norm(), 1e-7 * expected.displacement.norm());
    EXPECT_LE((found.stress - expected.stress).norm(), 1e-6 * expected.stress.norm());
    EXPECT_LE((found.reactions[1].force - expected.reactions[1].force).norm(),
              1e-7 * expected.reactions[1].force.norm());
    EXPECT_NEAR(found.volume_change, expected.volume_change, 1e-8);
  }
}

std::vector<BothWays> both_ways() {
  std::vector<BothWays> cases;
  for (int degree : {1, 2})
    for (double nu : {0.3, 0.4999})
      for (const char* law : {"linear", "hencky", "log_cauchy"})
        if (nu < 0.4 || std::string(law) != "log_cauchy") cases.push_back({degree, nu, law});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Solvers, Assembled, testing::ValuesIn(both_ways()), [](const auto& instance) {
  const BothWays& c = instance.param;
  return fmt::format("Q{}_{}_{:04.0f}", c.degree, c.law, 1e4 * c.poisson_ratio);
});

TEST(Tetrahedra, ReproduceAffineFieldsAndTheirStress) {
  Eigen::Matrix3d gradient;
  gradient << 0.01, 0.02, -0.01, 0.005, -0.02, 0.03, 0.015, -0.005, 0.01;
  for (int degree : {1, 2})
    for (double nu : {-0.5, 0.3, 0.4999}) {
      fem::GridProblem problem = test::fem_block(Vec3(1, 1, 1), {3, 3, 3}, 0, degree, nu);
      problem.coarse = test::tetrahedra_block(problem.coarse);
      problem.tolerance = 1e-11;
      for (const std::string& face : test::block_faces)
        problem.loads.push_back(PrescribedAffine{face, gradient, Vec3(0.1, 0, 0)});
      problem.points = problem.stress_points = test::points_inside(Vec3::Ones(), 10);
      const fem::Solution s = fem::solve_grid(problem);
      ASSERT_TRUE(s.ok) << s.message;
      const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
      const Eigen::Matrix3d stress = 2 * shear_modulus(problem.material) * strain +
                                     lame_lambda(problem.material) * strain.trace() * Eigen::Matrix3d::Identity();
      for (Eigen::Index k = 0; k < problem.points.rows(); ++k) {
        const Vec3 u = gradient * problem.points.row(k).transpose() + Vec3(0.1, 0, 0);
        EXPECT_LE((s.displacement.row(k).transpose() - u).norm(), 1e-9) << s.form;
        EXPECT_NEAR(s.stress(k, 0), stress(0, 0), 1e-6 * stress.norm()) << s.form;
        EXPECT_NEAR(s.stress(k, 5), stress(0, 2), 1e-6 * stress.norm()) << s.form;
      }
      EXPECT_NEAR(s.volume_change_first_order, strain.trace(), 1e-9);
    }
}

fem::Solution compressed(const Mesh& mesh, double nu) {
  fem::GridProblem problem = test::fem_block(Vec3(1, 1, 1), {4, 4, 4}, 0, 2, nu);
  problem.coarse = mesh;
  problem.tolerance = 1e-9;
  problem.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                   PrescribedDisplacement{"z_max", {0.0, 0.0, -0.05}}};
  problem.points = NodalVectors(0, 3);
  return fem::solve_grid(problem);
}

TEST(Tetrahedra, IterationsOfTheMixedFormDoNotGrowTowardsOneHalf) {
  const Mesh mesh = test::tetrahedra_block(test::fem_block(Vec3(1, 1, 1), {4, 4, 4}, 0, 2, 0.3).coarse);
  const fem::Solution s = compressed(mesh, 0.49), nearer = compressed(mesh, 0.499999);
  ASSERT_TRUE(s.ok && nearer.ok) << s.message << nearer.message;
  EXPECT_EQ(s.form, "P2-P1 mixed, GMRES, matrix-free, linear elements by Cholesky");
  EXPECT_LE(s.iterations, 70);
  EXPECT_LE(nearer.iterations, 1.3 * s.iterations);
}

TEST(Tetrahedra, SliversAreSolved) {
  Mesh mesh = test::tetrahedra_block(test::fem_block(Vec3(1, 1, 1), {4, 4, 4}, 0, 2, 0.3).coarse);
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n)
    if ((mesh.nodes.row(n) - Eigen::RowVector3d(0.5, 0.5, 0.5)).norm() < 1e-9) mesh.nodes(n, 0) += 0.2495;
  for (double nu : {0.25, 0.49}) {
    const fem::Solution s = compressed(mesh, nu);
    EXPECT_TRUE(s.ok) << s.message;
    EXPECT_LE(s.iterations, nu > 0.4 ? 170 : 60);
  }
}

// Under a uniform strain, in which the pressure is that of the whole of lambda.
TEST(Tetrahedra, FollowTheClosedFormAtLargeStrain) {
  const std::optional<double> is_free;
  for (const char* law : {"hencky", "neo_hooke", "neo_hooke_isochoric"})
    for (double nu : {0.3, 0.45, 0.499})
      for (double stretch : {0.8, 1.2}) {
        fem::GridProblem problem = test::fem_block(Vec3(1, 1, 1), {2, 2, 2}, 0, 2, nu);
        problem.coarse = test::tetrahedra_block(problem.coarse);
        problem.law = law;
        problem.loads = {PrescribedDisplacement{"x_min", {0.0, is_free, is_free}},
                         PrescribedDisplacement{"y_min", {is_free, 0.0, is_free}},
                         PrescribedDisplacement{"z_min", {is_free, is_free, 0.0}},
                         PrescribedDisplacement{"z_max", {is_free, is_free, stretch - 1}}};
        problem.points = problem.stress_points = Vec3::Ones().transpose();
        const fem::Solution s = fem::solve_grid(problem);
        ASSERT_TRUE(s.ok) << s.message;
        const auto [lateral, stress] = test::uniaxial(law, problem.material, stretch);
        EXPECT_NEAR(1 + s.displacement(0, 0), lateral, 1e-8) << s.form;
        EXPECT_NEAR(s.reactions[3].force[2] / stress, 1, 1e-7) << s.form;
        EXPECT_NEAR(s.stress(0, 2) * lateral * lateral / stress, 1, 1e-6) << s.form;  // Cauchy's
      }
}

// At the lower edge of its support det F is 0.68; with pressures alone for all of lambda it falls to 0.5.
TEST(Tetrahedra, ABodyThatHangsFromItsSideKeepsItsVolumeAtTheRim) {
  fem::GridProblem problem = test::fem_block(Vec3(0.16, 0.08, 0.08), {6, 3, 3}, 0, 2, 0.45);
  problem.coarse = test::tetrahedra_block(problem.coarse);
  problem.law = "hencky";
  problem.material.youngs_modulus = 8000;
  problem.material.density = 1000;
  problem.loads = {PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}}, Gravity{{0, 0, -9.81}}};
  problem.points = Vec3(0.16, 0.04, 0.04).transpose();
  const fem::Solution s = fem::solve_grid(problem);
  ASSERT_TRUE(s.ok) << s.message;
  EXPECT_NEAR(s.reactions[0].force[2], 0.16 * 0.08 * 0.08 * 1000 * 9.81, 1e-6);
  EXPECT_NEAR(s.displacement(0, 2), -0.178, 0.003);
  EXPECT_GT(s.min_jacobian, 0.6);
}

constexpr int n = 8, points = 4;  // of a cell

fem::CellShape random_shape() {
  fem::CellShape shape;
  shape.gradients = Eigen::MatrixXd::Random(3 * points, n);
  shape.gradients.rowwise() -= shape.gradients.colwise().mean();
  shape.weights = Eigen::VectorXd::Constant(points, 0.25) + 0.1 * Eigen::VectorXd::Random(points);
  return shape;
}

// A cube of one cell with a random state: tangent = d residual / d state, central differences.
TEST(CellEquations, TangentIsTheDerivativeOfTheResidual) {
  std::srand(3);
  fem::CellShape shape = random_shape();
  for (const fem::Form form : {fem::Form::pointwise, fem::Form::mean_dilatation, fem::Form::mixed})
    for (const char* name : {"", "hencky", "log_cauchy", "neo_hooke", "neo_hooke_isochoric", "st_venant_kirchhoff"}) {
      shape.pressures =
          form == fem::Form::mixed ? Eigen::MatrixXd(Eigen::MatrixXd::Random(points, 2)) : Eigen::MatrixXd(points, 0);
      const fem::CellLaw law{fem::law_named(name), form, 0.7, 1.9, form == fem::Form::mixed ? 0.6 : 0};
      fem::CellVector x{0.05 * Eigen::MatrixXd::Random(n, 3), 0.1 * Eigen::VectorXd::Random(shape.pressures.cols())};
      double smallest = 1;
      fem::CellTangent K;
      fem::cell_residual(law, shape, x, smallest, &K);
      ASSERT_GT(smallest, 0);
      const auto flat = [](const Eigen::MatrixXd& u) {
        const fem::CellMatrix rows = u;
        return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(rows.data(), rows.size()));
      };
      const double h = 1e-6;
      for (int j = 0; j < 3 * n; ++j) {
        fem::CellVector up = x, down = x;
        up.u(j / 3, j % 3) += h;
        down.u(j / 3, j % 3) -= h;
        const auto a = fem::cell_residual(law, shape, up, smallest, nullptr);
        const auto b = fem::cell_residual(law, shape, down, smallest, nullptr);
        EXPECT_LE((flat(a.u - b.u) / (2 * h) - K.uu.col(j)).norm(), 1e-6 * K.uu.norm()) << name;
        if (form == fem::Form::mixed) {
          EXPECT_LE(((a.p - b.p) / (2 * h) - K.pu.col(j)).norm(), 1e-6 * K.pu.norm()) << name;
        }
      }
      for (int j = 0; j < x.p.size(); ++j) {
        fem::CellVector up = x, down = x;
        up.p[j] += h;
        down.p[j] -= h;
        const auto a = fem::cell_residual(law, shape, up, smallest, nullptr);
        const auto b = fem::cell_residual(law, shape, down, smallest, nullptr);
        EXPECT_LE((flat(a.u - b.u) / (2 * h) - K.up.col(j)).norm(), 1e-6 * K.up.norm()) << name;
        EXPECT_LE(((a.p - b.p) / (2 * h) - K.pp.col(j)).norm(), 1e-6 * K.pp.norm()) << name;
      }
    }
}

// The work of a step's forces is the change of the energy, at whatever pressures meet the step's dilatations; no
// torque.
TEST(CellEquations, AStepDoesTheWorkOfTheEnergy) {
  std::srand(4);
  fem::CellShape shape = random_shape();
  for (const fem::Form form : {fem::Form::pointwise, fem::Form::mean_dilatation, fem::Form::mixed})
    for (const char* name : {"hencky", "neo_hooke", "neo_hooke_isochoric", "st_venant_kirchhoff"}) {
      shape.pressures =
          form == fem::Form::mixed ? Eigen::MatrixXd(Eigen::MatrixXd::Random(points, 2)) : Eigen::MatrixXd(points, 0);
      const fem::CellLaw law{fem::law_named(name), form, 0.7, 1.9};
      const auto state = [&] {
        return fem::CellVector{0.02 * Eigen::MatrixXd::Random(n, 3),
                               0.1 * Eigen::VectorXd::Random(shape.pressures.cols())};
      };
      const fem::CellVector before = state(), after = state(),
                            middle{(before.u + after.u) / 2, (before.p + after.p) / 2};
      double smallest = 1;
      const fem::CellVector f = fem::step_residual(law, shape, before, middle, smallest);
      ASSERT_GT(smallest, 0);
      const double work = f.u.cwiseProduct(after.u - before.u).sum() + f.p.dot(after.p - before.p),
                   change = fem::cell_energy(law, shape, after) - fem::cell_energy(law, shape, before);
      EXPECT_NEAR(work, change, 1e-9 * f.u.norm()) << name << static_cast<int>(form);
    }
}

}  // namespace
}  // namespace springproof::assembled_test
