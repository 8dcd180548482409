#include <gtest/gtest.h>

#include <random>

#include "msm/topology/random/surface_features.h"
#include "msm/topology/region.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::region_test {
namespace {

TEST(Region, GridAndRaysAgreeOnEveryPointOfALattice) {
  // Multiples of a sixteenth of a cell: most rays run through edges and corners of the surface.
  Mesh mesh = test::notched_block(0.5);
  const Region by_cells = region_of(mesh);
  mesh.grid.reset();
  const Region by_rays = region_of(mesh);
  EXPECT_NEAR(by_rays.volume, 10 * 0.125, 1e-14);
  int inside = 0;
  for (int i = -2; i <= 50; ++i)
    for (int j = -2; j <= 34; ++j)
      for (int k = -2; k <= 34; ++k) {
        const Vec3 p = Vec3(i, j, k) / 32;
        ASSERT_EQ(by_cells.inside(p), by_rays.inside(p)) << p.transpose();
        inside += by_rays.inside(p);
      }
  EXPECT_GT(inside, 10 * 16 * 16 * 16);
}

TEST(Region, TheBoundaryIsInsideAndNothingBeyond) {
  for (const bool tetrahedra : {false, true}) {
    Mesh mesh = block_mesh({3, 2, 1}, {3, 2, 1});
    if (tetrahedra) mesh = test::tetrahedra_of(mesh);
    const Region region = region_of(mesh);
    EXPECT_NEAR(region.volume, 6, 1e-14);
    std::mt19937 random(1);
    for (int n = 0; n < 2000; ++n) {
      Vec3 p(3.0 * random() / 4294967295.0, 2.0 * random() / 4294967295.0, random() / 4294967295.0);
      EXPECT_TRUE(region.inside(p));
      const int axis = n % 3;
      p[axis] = n % 2 ? 0 : region.upper[axis];
      EXPECT_TRUE(region.inside(p)) << p.transpose();
      p[axis] += n % 2 ? -1e-10 : 1e-10;
      EXPECT_FALSE(region.inside(p)) << p.transpose();
    }
  }
}

TEST(Region, RaysKnowATurnedTetrahedralBody) {
  Mesh mesh = test::tetrahedra_of(block_mesh({3, 2, 1}, {3, 2, 1}));
  const Eigen::Matrix3d R = test::rotation();
  mesh.nodes = (mesh.nodes * R.transpose()).eval();
  const Region region = region_of(mesh);
  std::mt19937 random(2);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = Vec3(5.0 * random() / 4294967295.0, 4.0 * random() / 4294967295.0, 3.0 * random() / 4294967295.0) -
                   Vec3(1, 1, 1);
    const bool expected = (p.array() >= 0).all() && (p.array() <= Vec3(3, 2, 1).array()).all();
    ASSERT_EQ(region.inside(R * p), expected) << p.transpose();
  }
}

TEST(Region, FeaturesAreTheCornersAndEdgesOfTheBody) {
  const SurfaceFeatures block = surface_features(region_of(block_mesh({3, 2, 1}, {6, 4, 2})));
  double length = 0;
  for (const auto& [a, b] : block.edges) length += (b - a).norm();
  EXPECT_EQ(block.corners.size(), 8u);
  EXPECT_NEAR(length, 24, 1e-12);
  const SurfaceFeatures round = surface_features(region_of(test::ball_of_tetrahedra(16)));
  EXPECT_TRUE(round.edges.empty());
  EXPECT_TRUE(round.corners.empty());
  EXPECT_THROW(region_of(Mesh{}), std::invalid_argument);
}

TEST(Region, ClosestPointBeatsEveryPointOfTheTriangle) {
  const Vec3 a(0, 0, 0), b(2, 0, 0.5), c(0.5, 1, 0);
  std::mt19937 random(4);
  const auto unit = [&] { return random() / 4294967295.0; };
  for (int n = 0; n < 300; ++n) {
    const Vec3 p(4 * unit() - 1, 3 * unit() - 1, 2 * unit() - 1);
    const double distance = (closest_point(p, a, b, c) - p).norm();
    double best = 1e9;
    for (int u = 0; u <= 60; ++u)
      for (int v = 0; u + v <= 60; ++v) best = std::min(best, (a + u / 60.0 * (b - a) + v / 60.0 * (c - a) - p).norm());
    EXPECT_LE(distance, best + 1e-12);
    EXPECT_GE(distance, best - 0.04);  // a step of the scan
  }
}

}  // namespace
}  // namespace springproof::region_test
