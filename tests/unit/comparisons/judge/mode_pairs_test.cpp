// Pairing of natural modes: multiplets, crossings, modes without a partner.
#include "comparisons/judge/mode_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace springproof::mode_pairs_test {
namespace {

constexpr int nodes = 4;

/// The displacement of one unknown alone.
NodalVectors unit(int unknown, double size = 1) {
  NodalVectors u = NodalVectors::Zero(nodes, 3);
  u.data()[unknown] = size;
  return u;
}

/// a cos t + b sin t.
NodalVectors mixed(const NodalVectors& a, const NodalVectors& b, double t) { return std::cos(t) * a + std::sin(t) * b; }

std::vector<std::optional<std::size_t>> partners(const std::vector<ModePair>& pairs) {
  std::vector<std::optional<std::size_t>> out;
  for (const ModePair& p : pairs) out.push_back(p.partner);
  return out;
}

using Partners = std::vector<std::optional<std::size_t>>;
const Eigen::VectorXd weights = Eigen::Vector4d(1, 2, 3, 4);

TEST(ModePairs, FollowShapesThatCross) {
  const ModeSet reference{{1, 2, 3}, {unit(0), unit(1), unit(2)}};
  const ModeSet computed{{1.1, 1.9, 2.5}, {unit(0, -7), unit(2, 2), unit(1)}};
  const std::vector<ModePair> pairs = pair_modes(reference, computed, weights);
  EXPECT_EQ(partners(pairs), (Partners{0, 2, 1}));
  for (const ModePair& p : pairs) EXPECT_NEAR(p.mac, 1, 1e-14);
}

TEST(ModePairs, OfAMultipletAreOfItsSubspaceInTheOrderOfFrequency) {
  const double t = 0.7;
  const ModeSet reference{{1, 1.005, 3}, {mixed(unit(0), unit(1), t), mixed(unit(0), unit(1), t + 1.2), unit(5)}};
  const ModeSet split{{1, 1.2, 3}, {unit(0), unit(1), unit(5)}};  // 45 degrees from the single modes
  EXPECT_EQ(partners(pair_modes(reference, split, weights)), (Partners{0, 1, 2}));
  EXPECT_EQ(partners(pair_modes(split, reference, weights)), (Partners{0, 1, 2}));
  const ModeSet apart{{1, 1.02, 3},
                      {mixed(unit(0), unit(1), t), mixed(unit(0), unit(1), t + std::numbers::pi / 2), unit(5)}};
  EXPECT_EQ(partners(pair_modes(apart, split, weights)), (Partners{{}, {}, 2}));  // beyond the multiplet's width
}

TEST(ModePairs, OfAMultipletThatSymmetryDoesNotMakeFollowShapes) {
  const ModeSet reference{{1, 1.005}, {unit(0), unit(1)}}, crossed{{0.95, 1.1}, {unit(1), unit(0)}};
  EXPECT_EQ(partners(pair_modes(reference, crossed, weights)), (Partners{1, 0}));
}

TEST(ModePairs, BelowTheLeastMacHaveNoPartner) {
  const double edge = std::acos(std::sqrt(least_mac));
  const ModeSet reference{{1, 2}, {unit(0), unit(7)}};
  for (const double t : {edge - 1e-6, edge + 1e-6}) {
    const std::vector<ModePair> pairs = pair_modes(reference, {{1}, {mixed(unit(0), unit(1), t)}}, weights);
    EXPECT_EQ(pairs[0].partner.has_value(), t < edge);
    EXPECT_NEAR(pairs[0].mac, least_mac, 1e-5);
    EXPECT_FALSE(pairs[1].partner);  // fewer computed modes than reference modes
    EXPECT_NEAR(pairs[1].mac, 0, 1e-12);
  }
}

TEST(ModePairs, AreAssignedForTheLargestSum) {
  // Greedy by the largest MAC would leave the second reference mode without a partner.
  const ModeSet reference{{1, 2}, {unit(0), mixed(unit(0), unit(1), 0.35)}};
  const ModeSet computed{{1, 2}, {mixed(unit(0), unit(1), -0.1), mixed(unit(0), unit(1), 0.02)}};
  EXPECT_EQ(partners(pair_modes(reference, computed, weights)), (Partners{0, 1}));
}

TEST(ModePairs, UseTheInnerProductOfTheWeights) {
  NodalVectors a = NodalVectors::Zero(nodes, 3), b = a;
  a.col(0) << 1, 1, 0, 0;
  b.col(0) << 1, -0.5, 0, 0;  // orthogonal in these weights alone
  EXPECT_NEAR(pair_modes({{1}, {a}}, {{1}, {b}}, weights)[0].mac, 0, 1e-14);
  EXPECT_GT(pair_modes({{1}, {a}}, {{1}, {b}}, Eigen::VectorXd::Ones(nodes))[0].mac, 0.05);
}

}  // namespace
}  // namespace springproof::mode_pairs_test
