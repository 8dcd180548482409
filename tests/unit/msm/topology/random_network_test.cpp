#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <set>

#include "msm/measure/statistics.h"
#include "msm/topology/random/random_network.h"
#include "support/bulk.h"
#include "support/solids.h"
#include "support/zoo.h"

namespace springproof::random_network_test {
namespace {

RandomParameters parameters(double spacing, std::uint64_t seed = 1) {
  RandomParameters p{};
  p.spacing = spacing;
  p.seed = seed;
  return p;
}

Region block(const Vec3& size) { return region_of(block_mesh(size, {2, 2, 2})); }

/// FNV-1a over the bits of the positions and the ends of the springs.
std::uint64_t fingerprint(const Network& network) {
  std::uint64_t hash = 14695981039346656037u;
  const auto mix = [&](std::uint64_t bits) { hash = (hash ^ bits) * 1099511628211u; };
  for (Eigen::Index i = 0; i < network.X.size(); ++i) mix(std::bit_cast<std::uint64_t>(network.X.data()[i]));
  for (const Spring& s : network.springs) mix((std::uint64_t(s.i) << 32) + s.j);
  return hash;
}

double smallest_distance(const Network& network, const Vec3* box = nullptr) {
  double smallest = 1e9;
  for (int i = 0; i < network.nodes(); ++i)
    for (int j = i + 1; j < network.nodes(); ++j) {
      if (box && (network.image_of[i] != i || network.image_of[j] != j)) continue;
      Vec3 d = (network.X.row(j) - network.X.row(i)).transpose();
      if (box) d -= box->cwiseProduct(d.cwiseQuotient(*box).array().round().matrix());
      smallest = std::min(smallest, d.norm());
    }
  return smallest;
}

using Pairs = std::set<std::pair<int, int>>;

Pairs pairs_of(const Network& network) {
  Pairs pairs;
  for (const Spring& s : network.springs) pairs.insert({s.i, network.image_of.empty() ? s.j : network.image_of[s.j]});
  return pairs;
}

std::string refusal(const Region& region, const RandomParameters& p) {
  try {
    random_network(region, p);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(RandomNetwork, TheSeedGivesEveryBit) {
  const Region region = block({6, 4, 4});
  const Network a = random_network(region, parameters(0.5, 7)), b = random_network(region, parameters(0.5, 7));
  EXPECT_EQ(fingerprint(a), fingerprint(b));
  EXPECT_NE(fingerprint(a), fingerprint(random_network(region, parameters(0.5, 8))));
  // Golden: the same on every machine and compiler.
  EXPECT_EQ(fingerprint(a), 16655830773942768777u);
  EXPECT_EQ(fingerprint(periodic_random_network({5, 5, 6}, parameters(0.5, 7))), 4674188663452602381u);
}

TEST(RandomNetwork, KeepsItsDistancesAndJoinsAllThatAreClose) {
  RandomParameters p = parameters(0.5);
  p.max_length = 1.5;
  for (const bool surface : {true, false}) {
    p.surface_nodes = surface;
    const Network network = random_network(block({4, 3, 3}), p);
    EXPECT_GE(smallest_distance(network), 0.8 * 0.5);
    Pairs expected;
    for (int i = 0; i < network.nodes(); ++i)
      for (int j = i + 1; j < network.nodes(); ++j)
        if ((network.X.row(j) - network.X.row(i)).norm() < 1.5 * 0.5) expected.insert({i, j});
    EXPECT_EQ(pairs_of(network), expected);
    EXPECT_EQ(expected.size(), network.springs.size());
    for (std::size_t n = 1; n < network.springs.size(); ++n) {
      const Spring &a = network.springs[n - 1], &b = network.springs[n];
      EXPECT_TRUE(a.i < b.i || (a.i == b.i && a.j < b.j));
      EXPECT_EQ(b.stiffness, 1);
    }
  }
}

TEST(RandomNetwork, PeriodicImagesAreConsistent) {
  const Vec3 box(4, 5, 4.5);
  RandomParameters p = parameters(0.5);
  p.max_length = 1.6;
  const Network network = periodic_random_network(box, p);
  const int N = int(std::lround(box.prod() / 0.125));
  ASSERT_EQ(network.image_of.size(), std::size_t(network.nodes()));
  EXPECT_GE(smallest_distance(network, &box), 0.8 * 0.5);
  for (int n = 0; n < network.nodes(); ++n) {
    const Vec3 shift = (network.X.row(n) - network.X.row(network.image_of[n])).transpose().cwiseQuotient(box);
    EXPECT_LT((shift - shift.array().round().matrix()).norm(), 1e-14);
    EXPECT_EQ(network.image_of[n] == n, n < N);
    EXPECT_EQ(network.image_of[n] == n, shift.norm() < 0.5);
    EXPECT_EQ(network.volume[n] > 0, n < N);
  }
  EXPECT_NEAR(network.volume.sum(), box.prod(), 1e-10);
  Pairs expected;
  for (int i = 0; i < N; ++i)
    for (int j = i + 1; j < N; ++j) {
      Vec3 d = (network.X.row(j) - network.X.row(i)).transpose();
      d -= box.cwiseProduct(d.cwiseQuotient(box).array().round().matrix());
      if (d.norm() < 1.6 * 0.5) expected.insert({i, j});
    }
  EXPECT_EQ(pairs_of(network), expected);
  EXPECT_EQ(expected.size(), network.springs.size());
  for (const Spring& s : network.springs) {
    EXPECT_LT(s.i, std::min(s.j, N));  // a ghost is never the first end
    EXPECT_NEAR((network.X.row(s.i) - network.X.row(s.j)).norm(), s.rest_length, 1e-14);
    EXPECT_LT(s.rest_length, 0.8);
  }
}

// Saturated random addition of balls fills 0.3841 of space, so minL/l = (6 * 0.3841 / pi)^(1/3) = 0.9018 at most.
TEST(RandomNetwork, JammingIsFoundAndRefused) {
  const Region region = block({14, 14, 14});
  for (const bool surface : {true, false}) {
    RandomParameters p = parameters(1);
    p.surface_nodes = surface;
    p.min_length = 0.94;  // the paper's largest
    const std::string why = refusal(region, p);
    ASSERT_NE(why.find("minL/l = 0.94 was asked for"), std::string::npos) << why;
    ASSERT_EQ(std::sscanf(why.c_str() + why.find("has room for"), "has room for minL/l = %lf", &p.min_length), 1)
        << why;
    EXPECT_NEAR(p.min_length, 0.9018, surface ? 0.015 : 0.004);
    p.min_length -= 0.003;  // the next sample jams a little earlier or later
    EXPECT_EQ(refusal(region, p), "");
  }
  RandomParameters p = parameters(1);
  p.min_length = 0.92;
  EXPECT_THROW(periodic_random_network({12, 12, 12}, p), std::invalid_argument);
  p.min_length = 0.88;
  EXPECT_NEAR(statistics(periodic_random_network({12, 12, 12}, p)).spacing, 1, 1e-12);
}

TEST(RandomNetwork, BulkHasTheDensityAndTheSpringsAskedFor) {
  for (const double min_length : {0.5, 0.8, 0.88})
    for (const bool surface : {true, false})
      for (const double springs : {10.0, 15.0, 22.0}) {
        RandomParameters p = parameters(0.1, 3);
        p.min_length = min_length;
        p.surface_nodes = surface;
        p.springs_per_node = springs;
        const Region region = block({1.8, 1.4, 1.4});
        const Network network = random_network(region, p);
        const test::Bulk bulk = test::bulk_of(network, region);
        // About 1000 nodes at random: their number is known to some 2 % at minL = 0.8 l, less well where they are
        // freer.
        EXPECT_NEAR(bulk.density * 1e-3, 1, min_length < 0.8 ? 0.05 : 0.025) << min_length << surface;
        EXPECT_NEAR(bulk.springs_per_node / springs, 1, min_length < 0.8 ? 0.06 : 0.03) << min_length << surface;
        EXPECT_NEAR(network.volume.sum(), 1.8 * 1.4 * 1.4, 1e-12);
        EXPECT_GT(network.volume.minCoeff(), 0);
      }
}

TEST(RandomNetwork, PeriodicNumbersAreExact) {
  RandomParameters p = parameters(0.2);
  for (const double springs : {8.2, 15.0, 29.0}) {
    p.springs_per_node = springs;
    NetworkRepair repaired;
    const Network network = periodic_random_network({2, 2, 2.4}, p, &repaired);
    const NetworkStatistics s = statistics(network);
    if (repaired.floppy_nodes == 0) {
      EXPECT_EQ(s.nodes, 1200);
      EXPECT_NEAR(s.springs_per_node, springs, 2.0 / s.nodes);
    }
    EXPECT_LT(repaired.floppy_nodes, springs < 10 ? 60 : 1);
  }
}

// Kot et al. (2014), sec. 3.3: <L> of 0.97-1.52 l, <S> of 8.2-29, deviations of 0.1-0.33 l, from maxL of 1.17-1.99 l.
TEST(RandomNetwork, ReachesTheRangesOfThePaper) {
  RandomParameters p = parameters(1);
  p.min_length = 0.81;
  p.springs_per_node = 29;
  const NetworkStatistics wide = statistics(periodic_random_network({10, 10, 10}, p));
  EXPECT_NEAR(wide.mean_length, 1.52, 0.05);
  EXPECT_NEAR(wide.length_deviation, 0.33, 0.03);
  p.min_length = 0.88;
  p.springs_per_node = 8.2;
  const NetworkStatistics narrow = statistics(periodic_random_network({10, 10, 10}, p));
  EXPECT_NEAR(narrow.mean_length, 1.04, 0.05);
  EXPECT_NEAR(narrow.length_deviation, 0.1, 0.02);
}

TEST(RandomNetwork, WindowsFillTheBodyAsOneSampleDoes) {
  RandomParameters p = parameters(1, 5);
  p.surface_nodes = false;
  p.windows = true;
  const Region region = block({14, 12, 12});
  const Network network = random_network(region, p);
  EXPECT_GE(smallest_distance(network), 0.8);
  const test::Bulk bulk = test::bulk_of(network, region);
  EXPECT_NEAR(bulk.density, 1, 0.03);
  EXPECT_NEAR(bulk.springs_per_node / 15, 1, 0.04);
  p.surface_nodes = true;
  EXPECT_NE(refusal(region, p), "");
}

TEST(RandomNetwork, AHundredThousandNodesTakeSeconds) {
  const auto start = std::chrono::steady_clock::now();
  const Network network = random_network(block({1, 1, 1}), parameters(0.0222));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::cout << network.nodes() << " nodes, " << network.springs.size() << " springs: " << seconds << " s\n";
  EXPECT_GT(network.nodes(), 90000);
  EXPECT_LT(seconds, 60);  // 2 to 3 s; quadratic cost would be minutes
  double mean_step = 0;    // neighbours are near in memory
  for (const Spring& s : network.springs) mean_step += double(s.j - s.i) / double(network.springs.size());
  EXPECT_LT(mean_step, 0.1 * network.nodes());
}

TEST(RandomNetwork, SpringsStayInABodyWithARecess) {
  const Mesh mesh = test::notched_block(1);
  const Region region = region_of(mesh);
  const Network network = random_network(region, parameters(0.3));
  int kept_out = 0;
  double longest = 0;
  for (const Spring& s : network.springs) {
    longest = std::max(longest, s.rest_length);
    const Vec3 a = network.X.row(s.i).transpose(), b = network.X.row(s.j).transpose();
    for (const double t : {0.25, 0.5, 0.75}) EXPECT_TRUE(region.inside(a + t * (b - a)));
  }
  const Pairs pairs = pairs_of(network);
  for (int i = 0; i < network.nodes(); ++i)
    for (int j = i + 1; j < network.nodes(); ++j)
      kept_out += (network.X.row(j) - network.X.row(i)).norm() < longest && !pairs.count({i, j});
  EXPECT_GT(kept_out, 0);  // pairs across the recess
  for (int n = 0; n < network.nodes(); ++n) EXPECT_TRUE(region.inside(network.X.row(n).transpose()));
  EXPECT_NEAR(network.volume.sum(), 10, 1e-12);
}

TEST(RandomNetwork, TheHullIsTheBody) {
  const Region region = block({3, 2, 2});
  const Network network = random_network(region, parameters(0.25));
  int corners = 0, faces = 0;
  for (int n = 0; n < network.nodes(); ++n) {
    int on = 0;
    for (int a = 0; a < 3; ++a) on += network.X(n, a) == 0 || network.X(n, a) == region.upper[a];
    corners += on == 3;
    faces += on > 0;
  }
  EXPECT_EQ(corners, 8);
  EXPECT_GT(faces, 0.8 * 32 / 0.0625);  // one per l^2
}

TEST(RandomNetwork, TakesTetrahedraAndBalls) {
  const Network cut = random_network(region_of(test::tetrahedra_of(block_mesh({2, 2, 1}, {3, 3, 2}))), parameters(0.2));
  EXPECT_NEAR(cut.volume.sum(), 4, 1e-12);
  // V/l^3 = 500, and what surface nodes add: 355 faces, 88 edges, 8 corners, each less what it replaces inside.
  EXPECT_NEAR(cut.nodes(), 778, 30);
  EXPECT_EQ(cut.X.colwise().maxCoeff(), Eigen::RowVector3d(2, 2, 1));
  const Region round = region_of(test::ball_of_tetrahedra(16));
  const Network sphere = random_network(round, parameters(0.075));
  EXPECT_GT(sphere.X.rowwise().norm().maxCoeff(), 0.499);
  const test::Bulk bulk(sphere, [](const Vec3& x) { return 0.49 - x.norm(); });
  EXPECT_NEAR(bulk.density * std::pow(0.075, 3), 1, 0.06);
  EXPECT_NEAR(sphere.volume.sum(), round.volume, 1e-12);
}

TEST(RandomNetwork, StiffnessFollowsItsExponent) {
  RandomParameters p = parameters(0.25);
  p.stiffness_exponent = 2;
  const Network network = random_network(block({2, 2, 2}), p);
  for (const Spring& s : network.springs) EXPECT_NEAR(s.stiffness * s.rest_length * s.rest_length, 0.0625, 1e-14);
}

TEST(RandomNetwork, RefusesWhatMakesNoNetwork) {
  const Region region = block({1, 1, 1});
  const auto refused = [&](auto change, const char* key) {
    RandomParameters p = parameters(0.2);
    change(p);
    EXPECT_EQ(refusal(region, p).rfind(key, 0), 0u) << key << ": " << refusal(region, p);
  };
  refused([](auto& p) { p.spacing = 0; }, "spacing");
  refused([](auto& p) { p.spacing = std::nan(""); }, "spacing");
  refused([](auto& p) { p.spacing = 1e-3; }, "spacing");  // 10^9 nodes
  refused([](auto& p) { p.spacing = 2; }, "spacing");
  refused([](auto& p) { p.min_length = 0; }, "min_length");
  refused([](auto& p) { p.min_length = -1; }, "min_length");
  refused([](auto& p) { p.max_length = 0.8; }, "max_length");
  refused([](auto& p) { p.max_length = 40; }, "max_length");
  refused([](auto& p) { p.springs_per_node = 3; }, "springs_per_node");
  refused([](auto& p) { p.springs_per_node = 1000; }, "springs_per_node");
  refused([](auto& p) { p.max_length = 0.95; }, "springs_per_node");  // nearly all nodes floppy
  EXPECT_THROW(periodic_random_network({1, 1, 0.5}, parameters(0.2)), std::invalid_argument);  // narrower than 3 maxL
}

}  // namespace
}  // namespace springproof::random_network_test
