#include "meshes/locate.h"

#include <gtest/gtest.h>

#include <random>

#include "support/tolerances.h"

namespace springproof {
namespace {

Vec3 position(const Mesh& mesh, const Location& location) {
  Vec3 x = Vec3::Zero();
  for (int n = 0; n < 8; ++n)
    x += location.shape[n] * mesh.nodes.row(mesh.hexahedra[location.cell][n]).transpose();
  return x;
}

/// Inner nodes moved at random: cells with curved faces that still fit each other.
Mesh distorted_block() {
  Mesh mesh = block_mesh({3, 2, 2}, {3, 2, 2});
  std::mt19937 generator(1);
  for (double& x : mesh.nodes.reshaped()) x += 0.2 * (generator() / 4294967295.0 - 0.5);
  return mesh;
}

TEST(Locate, PointInABox) {
  const Mesh mesh = block_mesh({4, 2, 1}, {4, 2, 1});
  const auto location = locate(mesh, {2.25, 1.5, 0.5});
  ASSERT_TRUE(location);
  EXPECT_EQ(location->cell, 4u + 2);
  // (1 - 0.25) (1 - 0.5) (1 - 0.5) at the lowest corner, and so on.
  const double expected[] = {0.1875, 0.0625, 0.0625, 0.1875, 0.1875, 0.0625, 0.0625, 0.1875};
  for (int n = 0; n < 8; ++n) EXPECT_NEAR(location->shape[n], expected[n], test::round_off);
}

TEST(Locate, DistortedCellsGiveThePointBack) {
  const Mesh mesh = distorted_block();
  std::mt19937 generator(2);
  for (int i = 0; i < 200; ++i) {
    Vec3 point;
    for (double& x : point) x = 0.2 + generator() / 4294967295.0 * 1.6;
    const auto location = locate(mesh, point);
    ASSERT_TRUE(location) << point.transpose();
    EXPECT_LE((position(mesh, *location) - point).norm(), test::round_off);
    EXPECT_NEAR(location->shape.sum(), 1, test::round_off);
    EXPECT_GE(location->shape.minCoeff(), -1e-9);
  }
}

TEST(Locate, EveryNodeIsFound) {
  for (const Mesh& mesh : {distorted_block(), block_mesh({0.3, 0.7, 0.1}, {7, 3, 3})})
    for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n)
      EXPECT_TRUE(locate(mesh, mesh.nodes.row(n).transpose())) << n;
}

TEST(Locate, FarFromTheOrigin) {
  Mesh mesh = distorted_block();
  mesh.nodes.rowwise() += Eigen::RowVector3d(1e6, -1e6, 1e6);
  for (const double offset : {0.31, 0.77, 1.13, 1.71})
    EXPECT_TRUE(locate(mesh, Vec3(1e6, -1e6, 1e6) + Vec3::Constant(offset))) << offset;
}

TEST(Locate, NothingOutside) {
  const Mesh mesh = block_mesh({1, 1, 1}, {2, 2, 2});
  for (const Vec3& point :
       {Vec3(1.001, 0.5, 0.5), Vec3(0.5, -0.001, 0.5), Vec3(5, 5, 5), Vec3(0.5, 0.5, NAN)})
    EXPECT_FALSE(locate(mesh, point)) << point.transpose();
  EXPECT_FALSE(locate(Mesh{}, Vec3::Zero()));
}

}  // namespace
}  // namespace springproof
