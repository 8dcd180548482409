// Where patches end.
#include "meshes/patches/rim.h"

#include <gtest/gtest.h>

#include <numbers>

namespace springproof::rim_test {
namespace {

double length(const std::vector<RimEdge>& rim) {
  double sum = 0;
  for (const RimEdge& e : rim) sum += (e.b - e.a).norm();
  return sum;
}

TEST(Rim, OfAFaceIsTheEdgesOfTheBlock) {
  const Mesh mesh = block_mesh({1, 2, 3}, {2, 3, 4});
  const std::vector<RimEdge> rim = rim_of(mesh, patch(mesh, "z_max"));
  EXPECT_EQ(rim.size(), 10u);
  EXPECT_NEAR(length(rim), 6, 1e-12);
  for (const RimEdge& e : rim) EXPECT_NEAR(e.turn, std::numbers::pi / 2, 1e-12);
  EXPECT_TRUE(ends_at_edges(rim));
}

TEST(Rim, WithinAFaceIsNoEdgeOfTheBody) {
  const Mesh mesh = block_mesh({1, 1, 1}, {3, 3, 3});
  Patch middle{"middle", {}};
  for (const auto& f : patch(mesh, "z_max").facets) {
    double x = 0;
    for (const int n : f) x += mesh.nodes(n, 0) / 4;
    if (x < 0.4) middle.facets.push_back(f);
  }
  const std::vector<RimEdge> rim = rim_of(mesh, middle);
  EXPECT_NEAR(length(rim), 2 + 2 / 3.0, 1e-12);
  EXPECT_FALSE(ends_at_edges(rim)) << "1 m of it runs across the face";
}

TEST(Rim, AClosedPatchHasNone) {
  const Mesh mesh = block_mesh({1, 1, 1}, {2, 2, 2});
  Patch all{"all", {}};
  for (const Patch& p : mesh.patches) all.facets.insert(all.facets.end(), p.facets.begin(), p.facets.end());
  EXPECT_TRUE(rim_of(mesh, all).empty());
  EXPECT_TRUE(ends_at_edges({}));
}

}  // namespace
}  // namespace springproof::rim_test
