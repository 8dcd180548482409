#include "comparisons/judge/deformation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

namespace springproof::wrinkles_test {
namespace {

NodalVectors field(const Mesh& mesh, const std::function<Vec3(const Vec3&)>& u) {
  NodalVectors values(mesh.nodes.rows(), 3);
  for (Eigen::Index n = 0; n < values.rows(); ++n) values.row(n) = u(mesh.nodes.row(n).transpose()).transpose();
  return values;
}

const Mesh& block() {
  static const Mesh mesh = block_mesh({4, 1, 1}, {16, 4, 4});
  return mesh;
}

TEST(Wrinkles, HomogeneousStatesHaveNoneHoweverTheyAreTurned) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Matrix3d H = turn * Vec3(1.2, 0.9, 1).asDiagonal().toDenseMatrix() - Eigen::Matrix3d::Identity();
  EXPECT_LT(wrinkles(block(), field(block(), [&](const Vec3& X) -> Vec3 { return H * X; })).share(), 1e-12);
  EXPECT_EQ(wrinkles(block(), NodalVectors::Zero(block().nodes.rows(), 3)).share(), 0);
}

// Bending has hourglass strain, alike in neighbours; the second mode of a beam changes it over its length.
TEST(Wrinkles, BendingHasFew) {
  const auto bent = [](const Vec3& X) { return Vec3(-0.1 * X[0] * X[2], 0, 0.05 * X[0] * X[0]); };
  EXPECT_LT(wrinkles(block(), field(block(), bent)).share(), 1e-3);
  const auto waves = [](const Vec3& X) { return Vec3(0, 0, 0.05 * std::sin(2 * X[0])); };
  EXPECT_LT(wrinkles(block(), field(block(), waves)).share(), 0.1);
}

// Golec et al. (2019), Figs. 3 and 6: u_z = (-1)^(i+j).
TEST(Wrinkles, TheWaveWithoutEnergyHasMost) {
  const auto wave = [](const Vec3& X) { return Vec3(0, 0, 0.01 * (std::lround(4 * (X[0] + X[1])) % 2 == 0 ? 1 : -1)); };
  EXPECT_NEAR(wrinkles(block(), field(block(), wave)).share(), std::sqrt(2 / 3.0), 0.03);  // two of three pairs
  const auto on_top = [&](const Vec3& X) -> Vec3 { return wave(X) + Vec3(0.02 * X[0], 0, 0); };
  EXPECT_GT(wrinkles(block(), field(block(), on_top)).share(), 0.5);
}

TEST(Wrinkles, RoundOffOfABodyThatFliesIsNone) {
  const auto flown = [](const Vec3& X) {
    const double at = X.dot(Vec3(0.3, 0.7, 0.9));
    return Vec3((at + 700.1) - at, (at - 0.3) - at, 0);
  };
  EXPECT_EQ(wrinkles(block(), field(block(), flown)).share(), 0);
  const auto wave = [](const Vec3& X) { return Vec3(0, 0, 1e-9 * (std::lround(4 * (X[0] + X[1])) % 2 == 0 ? 1 : -1)); };
  EXPECT_NEAR(wrinkles(block(), field(block(), wave)).share(), std::sqrt(2 / 3.0), 0.03);
}

}  // namespace
}  // namespace springproof::wrinkles_test
