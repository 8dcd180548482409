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

enum class Shape { straight, distorted, tetrahedra };

/// Of a solution at the problem's points, relative to the displacement that u(X) gives.
template <class Displacement>
double l2_error_of(const fem::GridProblem& problem, const Displacement& u) {
  const fem::Solution solution = fem::solve_grid(problem);
  EXPECT_TRUE(solution.ok) << solution.message;
  NodalVectors exact(problem.points.rows(), 3);
  for (Eigen::Index i = 0; i < exact.rows(); ++i) exact.row(i) = u(Vec3(problem.points.row(i).transpose())).transpose();
  return (solution.displacement - exact).norm() / exact.norm();
}

fem::GridProblem problem_of(const VectorField& u, int degree, double nu, int cells, Shape mesh) {
  int coarse = cells, refinements = 0;
  for (; mesh != Shape::tetrahedra && coarse % 2 == 0 && coarse > 2; coarse /= 2) ++refinements;
  fem::GridProblem problem = test::fem_block(Vec3::Ones(), {coarse, coarse, coarse}, refinements, degree, nu);
  if (mesh == Shape::tetrahedra) problem.coarse = test::tetrahedra_block(problem.coarse);
  problem.tolerance = 1e-10;
  if (mesh == Shape::distorted)
    problem.place = [](const Vec3& X) {
      const Vec3 s = (2 * pi * X).array().sin();
      return Vec3(X + 0.04 * Vec3(s[0] + s[0] * s[1], s[1] + s[1] * s[2], s[2] - s[2] * s[0]));
    };
  for (const std::string& face : test::block_faces)
    problem.loads.push_back(PrescribedDisplacement{face, {0.0, 0.0, 0.0}});
  const IsotropicMaterial material = problem.material;
  problem.body_force = [&u, material](const Vec3& x, double) { return body_force(u, x, material); };
  return problem;
}

double l2_error(const VectorField& u, int degree, double nu, int cells, Shape mesh) {
  fem::GridProblem problem = problem_of(u, degree, nu, cells, mesh);
  problem.points = test::points_inside(Vec3::Ones(), 3000);
  return l2_error_of(problem, [&u](const Vec3& X) { return displacement(u, X); });
}

/// Of the stress at the nodes within a block.
double l2_stress_error(const VectorField& u, int degree, double nu, int cells) {
  fem::GridProblem problem = problem_of(u, degree, nu, cells, Shape::straight);
  std::vector<Vec3> within;
  for (int i = 1; i < cells; ++i)
    for (int j = 1; j < cells; ++j)
      for (int k = 1; k < cells; ++k) within.push_back(Vec3(i, j, k) / cells);
  problem.stress_points.resize(static_cast<Eigen::Index>(within.size()), 3);
  for (std::size_t n = 0; n < within.size(); ++n) problem.stress_points.row(static_cast<Eigen::Index>(n)) = within[n];
  const fem::Solution solution = fem::solve_grid(problem);
  EXPECT_TRUE(solution.ok) << solution.message;
  double off = 0, size = 0;
  for (Eigen::Index n = 0; n < solution.stress.rows(); ++n) {
    Eigen::Matrix3d h;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        std::array<int, 3> once{};
        once[j] = 1;
        h(i, j) = derivative(u[i], within[static_cast<std::size_t>(n)], once);
      }
    const Eigen::Matrix3d S = shear_modulus(problem.material) * (h + h.transpose()) +
                              lame_lambda(problem.material) * h.trace() * Eigen::Matrix3d::Identity();
    Eigen::Matrix<double, 1, 6> exact;
    exact << S.diagonal().transpose(), S(0, 1), S(1, 2), S(0, 2);
    off += (solution.stress.row(n) - exact).squaredNorm();
    size += exact.squaredNorm();
  }
  return std::sqrt(off / size);
}

struct OrderCase {
  int degree;
  double poisson_ratio;
  Shape mesh;
  double least;  ///< order: what is missing of degree + 1

  std::string element() const { return fmt::format("{}{}", mesh == Shape::tetrahedra ? 'P' : 'Q', degree); }
};

class FemOrder : public testing::TestWithParam<OrderCase> {};

TEST_P(FemOrder, IsOneMoreThanTheDegree) {
  const auto& [degree, nu, mesh, least] = GetParam();
  const VectorField u = nu > 0.4 ? solenoidal() : general;
  const int fine = degree == 1 ? 16 : mesh == Shape::tetrahedra ? 8 : 12;
  const double coarse_error = l2_error(u, degree, nu, fine / 2, mesh), fine_error = l2_error(u, degree, nu, fine, mesh);
  const double order = test::recorded_order(
      GetParam().element(), fmt::format("{}small strain, ν = {:g}", mesh == Shape::distorted ? "distorted, " : "", nu),
      degree + 1, coarse_error, fine_error);
  EXPECT_GE(order, least) << coarse_error << " -> " << fine_error;
  if (least < 0) {
    EXPECT_GT(fine_error, 0.5) << "it does not lock";
  }
  if (least > degree + 0.8) {
    EXPECT_LE(fine_error, degree == 1 ? 5e-2 : 5e-3);
  }
}

// Linear tetrahedra lock near nu = 1/2 and have their order on finer meshes only.
std::vector<OrderCase> order_cases() {
  std::vector<OrderCase> cases;
  for (int degree : {1, 2}) {
    for (const auto& [nu, mesh] : std::vector<std::pair<double, Shape>>{
             {-0.5, Shape::distorted}, {0.25, Shape::straight}, {0.25, Shape::distorted}, {0.4999, Shape::distorted}})
      cases.push_back({degree, nu, mesh, degree + 0.9});
    cases.push_back({degree, 0.25, Shape::tetrahedra, degree + 0.6});
    cases.push_back({degree, 0.4999, Shape::tetrahedra, degree == 1 ? -1 : degree + 0.6});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Elements, FemOrder, testing::ValuesIn(order_cases()), [](const auto& instance) {
  const OrderCase& row = instance.param;
  return fmt::format("{}_{}_{}{:04.0f}", row.element(), row.mesh == Shape::distorted ? "distorted" : "straight",
                     row.poisson_ratio < 0 ? "minus_" : "", 1e4 * std::abs(row.poisson_ratio));
});

class FemOrderOfStress : public testing::TestWithParam<int> {};

// Of elements of degree 1 the mean at a node is one order better than the stress in its cells; those of degree 2 have
// it from their superconvergent points, linearly, and gain none.
TEST_P(FemOrderOfStress, IsTwoAtNodes) {
  const int degree = GetParam();
  const double coarse = l2_stress_error(general, degree, 0.25, 8), fine = l2_stress_error(general, degree, 0.25, 16);
  EXPECT_GE(test::recorded_order(fmt::format("Q{}, stress at nodes", degree), "ν = 0.25", 2, coarse, fine), 1.8);
}

INSTANTIATE_TEST_SUITE_P(Degrees, FemOrderOfStress, testing::Values(1, 2));

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
  problem.body_force = [&](const Vec3& X, double) { return test::body_force(x, P, 0, X, 0); };
  problem.points = test::points_inside(Vec3::Ones(), 1000);
  return l2_error_of(problem, [&x](const Vec3& X) -> Vec3 { return x(X, 0) - X; });
}

class FemOrderAtLargeStrain : public testing::TestWithParam<LargeStrainCase> {};

TEST_P(FemOrderAtLargeStrain, IsOneMoreThanTheDegree) {
  const int fine = GetParam().degree == 1 ? 16 : 8;
  const double coarse_error = large_strain_error(GetParam(), fine / 2),
               fine_error = large_strain_error(GetParam(), fine);
  const double order =
      test::recorded_order(fmt::format("Q{}", GetParam().degree), fmt::format("{}, bulge, ν = 0.3", GetParam().law),
                           GetParam().degree + 1, coarse_error, fine_error);
  EXPECT_GE(order, GetParam().degree + 1 - 0.2) << coarse_error << " -> " << fine_error;
}

INSTANTIATE_TEST_SUITE_P(Laws, FemOrderAtLargeStrain,
                         testing::Values(LargeStrainCase{"hencky", 1}, LargeStrainCase{"hencky", 2},
                                         LargeStrainCase{"neo_hooke", 1}, LargeStrainCase{"neo_hooke", 2}),
                         [](const auto& instance) {
                           return fmt::format("{}_Q{}", instance.param.law, instance.param.degree);
                         });

struct MotionCase {
  const char* law;
  int degree;
  bool tetrahedra, energy_momentum;
  double least = 1.8;  ///< order
};
void PrintTo(const MotionCase& row, std::ostream* out) {
  *out << fmt::format("{}{} {} {}", row.tetrahedra ? 'P' : 'Q', row.degree, row.law,
                      row.energy_momentum ? "energy-momentum" : "midpoint");
}

/// A bulge that comes in a second; its force is that of the middle of each step.
double error_in_motion(const MotionCase& row, int cells, int steps) {
  fem::GridProblem problem = test::fem_block(Vec3::Ones(), {cells, cells, cells}, 0, row.degree, 0.3);
  problem.material = {1, 0.3, 1};
  if (row.tetrahedra) problem.coarse = test::tetrahedra_block(problem.coarse);
  problem.law = row.law;
  for (const std::string& face : test::block_faces)
    problem.loads.push_back(PrescribedDisplacement{face, {0.0, 0.0, 0.0}});
  const test::ClosedMotion x = test::bulge([](double t) { return (1 - std::cos(3 * t)) / 2; });
  const test::PiolaStress P =
      std::string(row.law) == "hencky" ? test::hencky(problem.material) : test::neo_hookean(problem.material);
  problem.body_force = [&](const Vec3& X, double t) { return test::body_force(x, P, problem.material.density, X, t); };
  problem.motion = fem::MotionRequest{.duration = 1, .energy_momentum = row.energy_momentum};
  problem.steps = steps;
  problem.points = test::points_inside(Vec3::Ones(), 500);
  return l2_error_of(problem, [&x](const Vec3& X) -> Vec3 { return x(X, 1) - X; });
}

class FemOrderInTime : public testing::TestWithParam<MotionCase> {};

TEST_P(FemOrderInTime, IsTwo) {
  const MotionCase& row = GetParam();
  const double coarse = error_in_motion(row, 2, 4), fine = error_in_motion(row, 4, 8);
  const double order = test::recorded_order(fmt::format("{}{}, {}", row.tetrahedra ? 'P' : 'Q', row.degree,
                                                        row.energy_momentum ? "energy-momentum" : "midpoint rule"),
                                            fmt::format("{}, bulge in time", row.law), 2, coarse, fine);
  EXPECT_GE(order, row.least) << coarse << " -> " << fine;
}

// Two linear tetrahedra along an edge are not yet in the range of their order.
INSTANTIATE_TEST_SUITE_P(Elements, FemOrderInTime,
                         testing::Values(MotionCase{"neo_hooke", 1, false, false},
                                         MotionCase{"neo_hooke", 2, false, false},
                                         MotionCase{"neo_hooke", 2, false, true}, MotionCase{"hencky", 2, false, true},
                                         MotionCase{"neo_hooke", 1, true, true, 1.2},
                                         MotionCase{"neo_hooke", 2, true, true}));

}  // namespace
}  // namespace springproof::fem_manufactured_test
