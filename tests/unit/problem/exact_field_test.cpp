#include "problem/exact_field.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace springproof::exact_field_test {
namespace {

/// du_i/dx_j by central differences.
Eigen::Matrix3d gradient(const std::string& field, const Vec3& X, double h) {
  Eigen::Matrix3d H;
  for (int j = 0; j < 3; ++j) {
    const Vec3 step = h * Vec3::Unit(j);
    H.col(j) = (exact_displacement(field, X + step) - exact_displacement(field, X - step)) / (2 * h);
  }
  return H;
}

Eigen::Matrix3d stress(const std::string& field, const Vec3& X, const IsotropicMaterial& m, double h) {
  const Eigen::Matrix3d H = gradient(field, X, h);
  return shear_modulus(m) * (H + H.transpose()) + lame_lambda(m) * H.trace() * Eigen::Matrix3d::Identity();
}

// Points inside, on a face and at a corner of the unit cube.
const Vec3 points[] = {{0.3, 0.2, 0.7}, {0.55, 0.9, 0.15}, {0, 0.4, 0.6}, {0.7, 1, 0.3}, {1, 1, 1}};

TEST(ExactField, BodyForceBalancesTheStress) {
  for (const std::string& field : exact_field_names())
    for (const double nu : {-0.5, 0.25, 0.4})
      for (const Vec3& X : points) {
        const IsotropicMaterial m{1e4, nu};
        const double h = 1e-3;
        Vec3 divergence = Vec3::Zero();
        for (int j = 0; j < 3; ++j) {
          const Vec3 step = h * Vec3::Unit(j);
          divergence += (stress(field, X + step, m, h) - stress(field, X - step, m, h)).col(j) / (2 * h);
        }
        const Vec3 f = exact_body_force(field, X, m);
        // Central differences: h^2 pi^2 k^2 / 6, twice, of a force of the order of G pi^2 |u|.
        EXPECT_LE((f + divergence).norm(), 3e-5 * std::max(f.norm(), 1e3))
            << field << " nu " << nu << " at " << X.transpose();
        EXPECT_GT(f.norm(), 0);
      }
}

TEST(ExactField, SolenoidalHasNoDivergence) {
  for (const Vec3& X : points) {
    const Eigen::Matrix3d H = gradient("solenoidal", X, 1e-3);
    EXPECT_LE(std::abs(H.trace()), 2e-5 * H.norm());
    const Eigen::Matrix3d other = gradient("trigonometric", X, 1e-3);
    EXPECT_GT(std::abs(other.trace()), 1e-3 * other.norm());
  }
}

TEST(ExactField, IsNotZeroOnTheSurfaceAndItsComponentsDiffer) {
  for (const std::string& field : exact_field_names()) {
    const Vec3 u = exact_displacement(field, Vec3(0, 0.2, 0.3));
    EXPECT_GT(u.cwiseAbs().minCoeff(), 1e-4) << u.transpose();
    EXPECT_GT(std::abs(u[0] - u[1]), 1e-4);
    EXPECT_GT(std::abs(u[1] - u[2]), 1e-4);
  }
}

TEST(ExactField, SolenoidalForceStaysBoundedNearOneHalf) {
  const Vec3 X(0.3, 0.2, 0.7);
  const Vec3 at_04 = exact_body_force("solenoidal", X, {1e4, 0.4});
  const Vec3 near_half = exact_body_force("solenoidal", X, {1e4, 0.499999});
  EXPECT_LE((near_half - at_04 * 1.4 / 1.499999).norm(), 1e-6 * at_04.norm());
}

TEST(ExactField, AnUnknownNameIsRefused) {
  EXPECT_THROW(exact_displacement("sine", Vec3::Zero()), std::invalid_argument);
  EXPECT_THROW(exact_body_force("sine", Vec3::Zero(), {1e4, 0.3}), std::invalid_argument);
}

}  // namespace
}  // namespace springproof::exact_field_test
