// Depths in closed surfaces.
#include "meshes/regions/solid_shape.h"

#include <gtest/gtest.h>

#include <random>

#include "support/surfaces.h"

namespace springproof::enclosed_test {
namespace {

Vec3 in_box(std::mt19937& generator, double size) {
  Vec3 x;
  for (double& value : x) value = size * (generator() / 4294967295.0 - 0.5);
  return x;
}

double depth_in_box(const Vec3& x, const Vec3& size) {
  const Vec3 out = (x - size).cwiseMax(-x);
  return out.maxCoeff() > 0 ? -out.cwiseMax(0).norm() : -out.maxCoeff();
}

TEST(Enclosed, DepthsOfABoxAreExactBesideEdgesAndCorners) {
  const Vec3 size(1, 0.7, 0.4);
  const Enclosed box(test::box(size, 3));
  std::mt19937 generator(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 x = in_box(generator, 2) + size / 2;
    EXPECT_NEAR(box.depth(x), depth_in_box(x, size), 1e-12) << x.transpose();
  }
}

TEST(Enclosed, DepthsOfABallAreThoseOfItsChords) {
  const Enclosed ball(test::sphere(1, 4));
  std::mt19937 generator(2);
  for (int i = 0; i < 500; ++i) {
    const Vec3 x = in_box(generator, 4);
    EXPECT_NEAR(ball.depth(x), 1 - x.norm(), 3e-3);
  }
}

TEST(Enclosed, DepthsAreNegativeInACavity) {
  const Enclosed shell(test::both(test::sphere(1, 2), test::turned(test::sphere(0.5, 2))));
  EXPECT_LT(shell.depth({0.1, 0, 0}), -0.3);
  EXPECT_GT(shell.depth({0.75, 0, 0}), 0.2);
  EXPECT_LT(shell.depth({1.2, 0, 0}), -0.1);
}

TEST(Enclosed, OnlyABoxHasSharpEdges) {
  const Enclosed box(test::box({1, 1, 1}, 2)), ball(test::sphere(1, 2));
  const auto at = box.on_sharp_edge({0.9, 0.95, 0.3}, 0.2);
  ASSERT_TRUE(at);
  EXPECT_LT((*at - Vec3(1, 1, 0.3)).norm(), 1e-12);
  EXPECT_FALSE(box.on_sharp_edge({0.9, 0.95, 0.3}, 0.1));
  EXPECT_FALSE(ball.on_sharp_edge({1, 0, 0}, 10));
}

}  // namespace
}  // namespace springproof::enclosed_test
