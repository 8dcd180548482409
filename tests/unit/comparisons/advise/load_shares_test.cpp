// The kind of load that a displacement field is.
#include "comparisons/advise/pilot.h"

#include <gtest/gtest.h>

#include <functional>

namespace springproof::load_shares_test {
namespace {

constexpr double nu = 0.3;

/// Shares of a field of position about the middle of a bar of 6 x 1 x 1.
LoadShares shares_of(const std::function<Vec3(double x, double y, double z)>& field, int across = 4) {
  const Mesh mesh = block_mesh(Vec3(6, 1, 1), {6 * across, across, across});
  NodalVectors u(mesh.nodes.rows(), 3);
  for (Eigen::Index n = 0; n < u.rows(); ++n)
    u.row(n) = field(mesh.nodes(n, 0), mesh.nodes(n, 1) - 0.5, mesh.nodes(n, 2) - 0.5).transpose();
  return load_shares(mesh, u, {1e4, nu});
}

TEST(LoadShares, PureBendingStretchTorsionAndShearAreNamed) {
  const LoadShares bending = shares_of(
      [](double x, double y, double z) { return Vec3(-x * y, x * x / 2 + nu * (y * y - z * z) / 2, nu * y * z); });
  EXPECT_GT(bending.bending, 0.99);
  EXPECT_EQ(bending.largest(), "bending");
  EXPECT_EQ(bending.axis, 0);
  const LoadShares stretch = shares_of([](double x, double y, double z) { return Vec3(x, -nu * y, -nu * z); });
  EXPECT_NEAR(stretch.axial, 1, 1e-9);
  const LoadShares torsion = shares_of([](double x, double y, double z) { return Vec3(0, -x * z, x * y); });
  EXPECT_NEAR(torsion.torsion, 1, 1e-9);
  const LoadShares shear = shares_of([](double x, double, double) { return Vec3(0, x, 0); });
  EXPECT_NEAR(shear.shear, 1, 1e-9);
}

TEST(LoadShares, OneCellAcrossTiltsAndTurnsToo) {
  for (const int across : {1, 2}) {
    EXPECT_GT(shares_of([](double x, double y,
                           double z) { return Vec3(-x * y, x * x / 2 + nu * (y * y - z * z) / 2, nu * y * z); },
                        across)
                  .bending,
              across == 1 ? 0.9 : 0.97)
        << across;
    EXPECT_NEAR(shares_of([](double x, double y, double z) { return Vec3(0, -x * z, x * y); }, across).torsion, 1,
                1e-9);
  }
}

TEST(LoadShares, WhatVariesWithinASectionIsLocal) {
  const LoadShares s = shares_of([](double, double y, double z) { return Vec3(y * z, 0, 0); });  // warping
  EXPECT_GT(s.local, 0.5);
  const LoadShares none = shares_of([](double, double, double) { return Vec3(1, 2, 3); });
  EXPECT_EQ(none.local, 1);
}

}  // namespace
}  // namespace springproof::load_shares_test
