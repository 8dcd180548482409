// Observed orders on manufactured solutions: L2 rate p + 1, on straight and distorted meshes, also where the
// solid is nearly incompressible.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/fem_block.h"
#include "support/manufactured.h"

namespace springproof::fem_manufactured_test {
namespace {

constexpr double pi = 3.14159265358979323846;

// u_i = sum of terms a * product over j of sin(k_j pi x_j + phase_j), which derivatives only shift.
struct Term {
  double amplitude;
  std::array<double, 3> k;
  std::array<double, 3> phase;
};

double derivative(const Term& t, const Vec3& x, const std::array<int, 3>& orders) {
  double value = t.amplitude;
  for (int j = 0; j < 3; ++j)
    value *= std::pow(t.k[j] * pi, orders[j]) * std::sin(t.k[j] * pi * x[j] + t.phase[j] + orders[j] * pi / 2);
  return value;
}

using VectorField = std::array<std::vector<Term>, 3>;

double derivative(const std::vector<Term>& terms, const Vec3& x, const std::array<int, 3>& orders) {
  double value = 0;
  for (const Term& t : terms) value += derivative(t, x, orders);
  return value;
}

Vec3 displacement(const VectorField& u, const Vec3& x) {
  return {derivative(u[0], x, {0, 0, 0}), derivative(u[1], x, {0, 0, 0}), derivative(u[2], x, {0, 0, 0})};
}

// -div stress = -(mu laplace u + (lambda + mu) grad div u)
Vec3 body_force(const VectorField& u, const Vec3& x, const IsotropicMaterial& material) {
  const double mu = shear_modulus(material), lambda = lame_lambda(material);
  Vec3 f = Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      std::array<int, 3> jj{}, ij{};
      jj[j] = 2;
      ++ij[i];
      ++ij[j];
      f[i] -= mu * derivative(u[i], x, jj) + (lambda + mu) * derivative(u[j], x, ij);
    }
  return f;
}

// Zero on the unit cube's surface, all components different.
const VectorField general = {
    {{{1.0, {1, 1, 1}, {0, 0, 0}}}, {{-0.7, {1, 2, 1}, {0, 0, 0}}}, {{0.5, {2, 1, 1}, {0, 0, 0}}}}};

// curl of (0, 0, sin^2(pi x) sin^2(pi y) sin(pi z)): no divergence, zero on the surface.
// sin^2 = (1 - cos 2) / 2 and its derivative is pi sin 2; a constant is a sine with k = 0 and phase pi/2.
VectorField solenoidal() {
  const double c = pi / 2;
  const Term x_flat{c, {0, 2, 1}, {pi / 2, 0, 0}}, x_wave{-c, {2, 2, 1}, {pi / 2, 0, 0}};
  const Term y_flat{-c, {2, 0, 1}, {0, pi / 2, 0}}, y_wave{c, {2, 2, 1}, {0, pi / 2, 0}};
  return {{{x_flat, x_wave}, {y_flat, y_wave}, {}}};
}

double l2_error(const VectorField& u, int degree, double nu, int cells, bool distorted) {
  int coarse = cells, refinements = 0;
  for (; coarse % 2 == 0 && coarse > 2; coarse /= 2) ++refinements;
  fem::GridProblem problem = test::fem_block(Vec3::Ones(), {coarse, coarse, coarse}, refinements, degree, nu);
  problem.tolerance = 1e-10;
  if (distorted)
    problem.place = [](const Vec3& X) {
      const Vec3 s = (2 * pi * X).array().sin();
      return Vec3(X + 0.04 * Vec3(s[0] + s[0] * s[1], s[1] + s[1] * s[2], s[2] - s[2] * s[0]));
    };
  for (const std::string& face : test::block_faces)
    problem.loads.push_back(PrescribedDisplacement{face, {0.0, 0.0, 0.0}});
  const IsotropicMaterial material = problem.material;
  problem.body_force = [&u, material](const Vec3& x) { return body_force(u, x, material); };
  problem.points = test::points_inside(Vec3::Ones(), 3000);
  const fem::Solution solution = fem::solve_grid(problem);
  EXPECT_TRUE(solution.ok) << solution.message;
  NodalVectors exact(problem.points.rows(), 3);
  for (Eigen::Index i = 0; i < exact.rows(); ++i) exact.row(i) = displacement(u, problem.points.row(i)).transpose();
  return (solution.displacement - exact).norm() / exact.norm();
}

struct OrderCase {
  int degree;
  double poisson_ratio;
  bool distorted;
};

class FemOrder : public testing::TestWithParam<OrderCase> {};

TEST_P(FemOrder, IsOneMoreThanTheDegree) {
  const auto [degree, nu, distorted] = GetParam();
  const VectorField u = nu > 0.4 ? solenoidal() : general;
  const int fine = degree == 1 ? 16 : 12;
  const double coarse_error = l2_error(u, degree, nu, fine / 2, distorted);
  const double fine_error = l2_error(u, degree, nu, fine, distorted);
  RecordProperty("fine_error", fmt::format("{:.3e}", fine_error));
  EXPECT_GE(std::log2(coarse_error / fine_error), degree + 1 - 0.1) << coarse_error << " -> " << fine_error;
  EXPECT_LE(fine_error, degree == 1 ? 5e-2 : 5e-3);
}

std::vector<OrderCase> order_cases() {
  std::vector<OrderCase> cases;
  for (int degree : {1, 2})
    for (const auto& [nu, distorted] :
         std::vector<std::pair<double, bool>>{{-0.5, true}, {0.25, false}, {0.25, true}, {0.4999, true}})
      cases.push_back({degree, nu, distorted});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Elements, FemOrder, testing::ValuesIn(order_cases()), [](const auto& instance) {
  return fmt::format("Q{}_{}_{}{:04.0f}", instance.param.degree, instance.param.distorted ? "distorted" : "straight",
                     instance.param.poisson_ratio < 0 ? "minus_" : "", 1e4 * std::abs(instance.param.poisson_ratio));
});

struct LargeStrainCase {
  const char* law;
  int degree;
};

double large_strain_error(const LargeStrainCase& row, int cells) {
  fem::GridProblem problem = test::fem_block(Vec3::Ones(), {cells / 2, cells / 2, cells / 2}, 1, row.degree, 0.3);
  problem.law = row.law;
  problem.tolerance = 1e-9;
  for (const std::string& face : test::block_faces)
    problem.loads.push_back(PrescribedDisplacement{face, {0.0, 0.0, 0.0}});
  const test::ClosedMotion x = test::bulge([](double) { return 1; });
  const test::PiolaStress P =
      std::string(row.law) == "hencky" ? test::hencky(problem.material) : test::neo_hookean(problem.material);
  problem.body_force = [&](const Vec3& X) { return test::body_force(x, P, 0, X, 0); };
  problem.points = test::points_inside(Vec3::Ones(), 1000);
  const fem::Solution solution = fem::solve_grid(problem);
  EXPECT_TRUE(solution.ok) << solution.message;
  NodalVectors exact(problem.points.rows(), 3);
  for (Eigen::Index i = 0; i < exact.rows(); ++i) {
    const Vec3 X = problem.points.row(i).transpose();
    exact.row(i) = (x(X, 0) - X).transpose();
  }
  return (solution.displacement - exact).norm() / exact.norm();
}

class FemOrderAtLargeStrain : public testing::TestWithParam<LargeStrainCase> {};

TEST_P(FemOrderAtLargeStrain, IsOneMoreThanTheDegree) {
  const int fine = GetParam().degree == 1 ? 16 : 8;
  const double coarse_error = large_strain_error(GetParam(), fine / 2),
               fine_error = large_strain_error(GetParam(), fine);
  RecordProperty("errors", fmt::format("{:.2e} {:.2e}", coarse_error, fine_error));
  EXPECT_GE(std::log2(coarse_error / fine_error), GetParam().degree + 1 - 0.2) << coarse_error << " -> " << fine_error;
}

INSTANTIATE_TEST_SUITE_P(Laws, FemOrderAtLargeStrain,
                         testing::Values(LargeStrainCase{"hencky", 1}, LargeStrainCase{"hencky", 2},
                                         LargeStrainCase{"neo_hooke", 1}, LargeStrainCase{"neo_hooke", 2}),
                         [](const auto& instance) {
                           return fmt::format("{}_Q{}", instance.param.law, instance.param.degree);
                         });

}  // namespace
}  // namespace springproof::fem_manufactured_test
