#include "problem/kelvin.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace springproof::kelvin_test {
namespace {

const KelvinSolution solution{{1, -2, 4}, {0.3, 0.1, -0.2}, {70, 0.31, 1000}};
const Vec3 places[] = {{1.3, 0.2, 0.4}, {0.3, 0.1, 0.9}, {-0.6, 1.7, -2}};

/// d f / dx_j by central differences of fourth order.
template <class F>
auto derivative(const F& f, const Vec3& X, int j) {
  const double h = 1e-3;
  const Vec3 e = h * Vec3::Unit(j);
  return ((8 * (f(X + e) - f(X - e)) - (f(X + 2 * e) - f(X - 2 * e))) / (12 * h)).eval();
}

TEST(Kelvin, StrainIsThatOfTheDisplacement) {
  for (const Vec3& X : places) {
    Eigen::Matrix3d gradient;
    for (int j = 0; j < 3; ++j)
      gradient.col(j) = derivative([](const Vec3& p) { return kelvin_displacement(solution, p); }, X, j);
    const Eigen::Matrix3d strain = kelvin_strain(solution, X);
    EXPECT_LE(((gradient + gradient.transpose()) / 2 - strain).norm(), 1e-8 * strain.norm());
  }
}

TEST(Kelvin, StressIsHookesOfTheStrain) {
  for (const Vec3& X : places) {
    const Eigen::Matrix3d strain = kelvin_strain(solution, X), stress = kelvin_stress(solution, X);
    const double G = shear_modulus(solution.material), lambda = lame_lambda(solution.material);
    EXPECT_LE((2 * G * strain + lambda * strain.trace() * Eigen::Matrix3d::Identity() - stress).norm(),
              1e-13 * stress.norm());
  }
}

TEST(Kelvin, NoBodyForceActsAwayFromThePoint) {
  for (const Vec3& X : places) {
    Vec3 divergence = Vec3::Zero();
    double size = 0;
    for (int j = 0; j < 3; ++j) {
      const Eigen::Matrix3d d = derivative([](const Vec3& p) { return kelvin_stress(solution, p); }, X, j);
      divergence += d.col(j);
      size += d.norm();
    }
    EXPECT_LE(divergence.norm(), 1e-8 * size);
  }
}

/// The sign of (24): the tractions on a sphere round the point balance the force.
TEST(Kelvin, TractionsOnASphereBalanceTheForce) {
  const double R = 0.7;
  const int rings = 40, points = 80;
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < points; ++k) {
      const double z = -1 + (2 * i + 1.0) / rings, phi = 2 * std::numbers::pi * k / points, r = std::sqrt(1 - z * z);
      const Vec3 n(r * std::cos(phi), r * std::sin(phi), z);
      sum += kelvin_stress(solution, solution.at + R * n) * n * (4 * std::numbers::pi * R * R / (rings * points));
    }
  EXPECT_LE((sum + solution.force).norm(), 1e-2 * solution.force.norm());
}

TEST(Kelvin, IsRefusedWhereTheForceActs) {
  EXPECT_THROW(kelvin_displacement(solution, solution.at), std::invalid_argument);
  EXPECT_THROW(kelvin_strain(solution, solution.at), std::invalid_argument);
  EXPECT_THROW(kelvin_stress(solution, solution.at), std::invalid_argument);
}

}  // namespace
}  // namespace springproof::kelvin_test
