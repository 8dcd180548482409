// Measures of cracks, on cracks that were cut by hand.
#include "msm/fracture/cracks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "msm/topology/lattices_without_cells.h"
#include "msm/topology/random/random_network.h"

namespace springproof::cracks_test {
namespace {

constexpr double degree = std::numbers::pi / 180;

Mesh plate() { return block_mesh({24, 24, 4}, {24, 24, 4}); }

Network cubic() { return node_lattice(plate(), isotropic_pattern(std::numeric_limits<double>::infinity())); }

Network disordered() {
  RandomParameters p{};
  p.spacing = 1;
  p.surface_nodes = false;
  return random_network(region_of(plate()), p);
}

/// Springs cut by the vertical plane through the middle of the plate, `angle` [rad] from x, shifted by 0.3.
std::vector<char> cut(const Network& network, double angle) {
  const Vec3 normal(-std::sin(angle), std::cos(angle), 0);
  const auto side = [&](int n) { return normal.dot(network.X.row(n).transpose() - Vec3(12, 12, 0)) > 0.3; };
  std::vector<char> broken;
  for (const Spring& s : network.springs) broken.push_back(side(s.i) != side(s.j));
  return broken;
}

TEST(CrackDirections, OfAStraightCrackAreItsOwnInAnyNetwork) {  // within 2 degrees
  for (const Network& network : {cubic(), disordered()})
    for (const double angle : {0.0, 11.0, 22.5, 33.0, 45.0, 70.0}) {
      const CrackDirections d = crack_directions(network, cut(network, angle * degree));
      EXPECT_GT(d.springs, 100);
      EXPECT_GT(d.order_4, 0.9) << angle;
      EXPECT_NEAR(d.along_4 / d.order_4, std::cos(4 * angle * degree), 4 * 2 * degree) << angle;
      EXPECT_GT(d.order_8, 0.6) << angle;
      EXPECT_NEAR(d.along_8 / d.order_8, std::cos(8 * angle * degree), 8 * 2 * degree) << angle;
    }
}

TEST(CrackDirections, FavourNoneInTheMeanOverStraightCracks) {
  for (const Network& network : {cubic(), disordered()}) {
    double along_4 = 0, along_8 = 0;
    constexpr int angles = 36;
    for (int i = 0; i < angles; ++i) {
      const CrackDirections d = crack_directions(network, cut(network, (i + 0.5) * 90 * degree / angles));
      along_4 += d.along_4 / angles;
      along_8 += d.along_8 / angles;
    }
    EXPECT_NEAR(along_4, 0, 0.05);
    EXPECT_NEAR(along_8, 0, 0.05);
  }
}

TEST(CrackDirections, FillTheBinOfTheirAngle) {
  const Network network = disordered();
  const CrackDirections d = crack_directions(network, cut(network, 25 * degree));
  double sum = 0;
  for (const double share : d.share) sum += share;
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_GT(d.share[2], 0.5);  // 20 to 30 degrees
}

TEST(CrackDirections, OfNothingAreNothing) {
  const Network network = cubic();
  EXPECT_EQ(crack_directions(network, std::vector<char>(network.springs.size(), 0)).springs, 0);
}

TEST(CrackArea, OfAPlaneIsItsArea) {
  for (const Network& network : {disordered(), cubic()})
    EXPECT_NEAR(crack_area(network, cut(network, 0)) / (24 * 4), 1, 0.13);
}

/// The parts on both sides of the cut, moved apart by `opening` each.
NodalVectors opened(const Network& network, double angle, double opening) {
  const Vec3 normal(-std::sin(angle), std::cos(angle), 0);
  NodalVectors u(network.nodes(), 3);
  for (int n = 0; n < network.nodes(); ++n)
    u.row(n) =
        (normal.dot(network.X.row(n).transpose() - Vec3(12, 12, 0)) > 0.3 ? opening : -opening) * normal.transpose();
  return u;
}

TEST(Fragments, AreThePartsThatMoveApart) {
  for (const Network& network : {cubic(), disordered()}) {
    const std::vector<double> none(network.springs.size(), 0), tenth(network.springs.size(), 0.1);
    const NodalVectors one = opened(network, 20 * degree, 0.2), two = one + opened(network, 100 * degree, 0.2);
    EXPECT_EQ(fragments(network, 0 * flat(one), none, 0.1), 1);
    EXPECT_EQ(fragments(network, flat(one), none, 0.1), 2);
    EXPECT_EQ(fragments(network, flat(two), none, 0.1), 4);
    EXPECT_EQ(fragments(network, flat(two), none, 1), 1);
    const NodalVectors shrunk = -0.1 * network.X;
    EXPECT_EQ(fragments(network, flat(shrunk), tenth, 0.01), 1);
  }
}

}  // namespace
}  // namespace springproof::cracks_test
