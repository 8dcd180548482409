// Drying networks: equilibrium under shrinkage, breaking, the balance of energy.
#include "msm/fracture/fracture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "msm/topology/lattices_without_cells.h"
#include "msm/topology/random/random_network.h"
#include "support/bodies.h"

namespace springproof::fracture_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Held {
  Network network;
  std::vector<char> nodes;
};

/// The nodes below `depth` are held.
Held held_below(Network network, double depth) {
  std::vector<char> held(network.nodes());
  for (int n = 0; n < network.nodes(); ++n) held[n] = network.X(n, 2) < depth;
  return {std::move(network), std::move(held)};
}

/// A slab of 10 x 10 x 3 nodes, the lowest layer held.
Held slab() { return held_below(node_lattice(block_mesh({10, 10, 3}, {10, 10, 3}), isotropic_pattern(infinity)), 1); }

Held disordered_slab(std::uint64_t seed) {
  RandomParameters p{};
  p.spacing = 1;
  p.seed = seed;
  p.surface_nodes = false;
  return held_below(random_network(region_of(block_mesh({10, 10, 3}, {10, 10, 3})), p), 0.8);
}

Fracture drying() {
  Fracture f;
  f.shrinkage = 0.12;
  f.steps = 30;
  f.depth = 1.5;
  f.threshold = 0.05;
  f.scatter = 0.1;
  f.apart = 2;
  return f;
}

/// Nodes in a row, a spring of stiffness k between each and the next.
Network chain(int nodes, double k = 3) {
  Network network;
  network.X = NodalVectors::Zero(nodes, 3);
  for (int n = 0; n < nodes; ++n) network.X(n, 0) = n;
  for (int n = 0; n + 1 < nodes; ++n) network.springs.push_back({n, n + 1, k * (n + 1), 1});
  network.volume = Eigen::VectorXd::Ones(nodes);
  return network;
}

TEST(ShrinkingSprings, InARowPullAlike) {
  ShrinkingSprings springs(chain(3), {true, false, true}, {1, 0.5});
  springs.set_amplitude(0.1);
  EXPECT_TRUE(springs.solve(1e-12, 10).converged);
  // k1 (u + 0.1) = k2 (-u + 0.05), k2 = 2 k1 = 6: u = 0, T = 0.3 N.
  EXPECT_NEAR(springs.displacement()[3], 0, 1e-12);
  EXPECT_NEAR(springs.stretch(0), 0.1, 1e-12);
  EXPECT_NEAR(springs.stretch(1), 0.05, 1e-12);
  EXPECT_NEAR(springs.energy(), 3 * 0.01 / 2 + 6 * 0.0025 / 2, 1e-12);
  EXPECT_NEAR(springs.eigen_power(), 0.3 * 1 + 0.3 * 0.5, 1e-12);
  springs.remove(1);
  EXPECT_TRUE(springs.solve(1e-12, 10).converged);
  EXPECT_NEAR(springs.stretch(0), 0, 1e-12);
  EXPECT_NEAR(springs.displacement()[3], -0.1, 1e-12);
}

TEST(ShrinkingSprings, ThatCameLooseHaveNoTension) {
  const Held body = slab();
  ShrinkingSprings springs(body.network, body.nodes, std::vector<double>(body.network.springs.size(), 1));
  for (std::size_t s = 0; s < body.network.springs.size(); ++s)  // the uppermost layer, cut off
    if (const Spring& spring = body.network.springs[s];
        (body.network.X(spring.i, 2) > 2) != (body.network.X(spring.j, 2) > 2))
      springs.remove(static_cast<int>(s));
  springs.set_amplitude(0.1);
  EXPECT_TRUE(springs.solve(1e-10, 1000).converged);
  for (std::size_t s = 0; s < body.network.springs.size(); ++s)
    if (body.network.X(body.network.springs[s].i, 2) > 2 && body.network.X(body.network.springs[s].j, 2) > 2) {
      EXPECT_NEAR(springs.stretch(static_cast<int>(s)), 0, 1e-8);
    }
}

TEST(Fracture, AChainBreaksOnceAtItsWeakestSpring) {
  Fracture f;
  f.shrinkage = 0.1;
  f.steps = 1000;
  f.threshold = 0.05;
  f.scatter = 0.2;
  Network network = chain(11);
  for (Spring& s : network.springs) s.stiffness = 3;
  std::vector<char> ends(11, false);
  ends.front() = ends.back() = true;
  const FractureResult r = run_fracture(network, ends, f, 7);
  const std::vector<double> limits = thresholds(f, network.springs.size(), 7);
  const auto weakest = std::min_element(limits.begin(), limits.end());
  EXPECT_EQ(r.steps.back().broken, 1);
  EXPECT_EQ(r.broken_at[weakest - limits.begin()], static_cast<int>(std::ceil(*weakest / 1e-4)));
  EXPECT_NEAR(r.steps.back().stored, 0, 1e-12);
}

TEST(Fracture, ThresholdsScatterAsAsked) {
  Fracture f = drying();
  f.scatter = 0.2;
  const std::vector<double> all = thresholds(f, 100000, 1);
  double mean = 0, square = 0;
  for (const double t : all) mean += t / 1e5, square += t * t / 1e5;
  EXPECT_NEAR(mean, 0.05, 2e-4);
  EXPECT_NEAR(std::sqrt(square - mean * mean) / mean, 0.2, 2e-3);
}

TEST(Fracture, NothingBreaksThatDoesNotDry) {
  const Held body = slab();
  Fracture f = drying();
  f.shrinkage = 0;
  const FractureResult r = run_fracture(body.network, body.nodes, f, 1);
  EXPECT_EQ(r.steps.back().broken, 0);
  EXPECT_EQ(r.steps.back().stored, 0);
  EXPECT_TRUE(r.displacement.isZero(0));
}

TEST(Fracture, TheSameSeedGivesTheSameCracks) {
  for (const Held& body : {slab(), disordered_slab(3)}) {
    const FractureResult a = run_fracture(body.network, body.nodes, drying(), 5),
                         b = run_fracture(body.network, body.nodes, drying(), 5),
                         c = run_fracture(body.network, body.nodes, drying(), 6);
    EXPECT_GT(a.steps.back().broken, 20);
    EXPECT_EQ(a.broken_at, b.broken_at);
    EXPECT_NE(a.broken_at, c.broken_at);
  }
}

TEST(Fracture, EnergyIsBalancedAtEveryStep) {
  for (const Held& body : {slab(), disordered_slab(3)}) {
    const Fracture f = drying();
    const FractureResult r = run_fracture(body.network, body.nodes, f, 5);
    EXPECT_LT(r.imbalance(), 1e-6);
    EXPECT_GT(r.released(), 0.1 * r.steps.back().work);
    // The energy stored at the end, from displacement and springs alone.
    const std::vector<double> profile = drying_profile(f, body.network);
    double stored = 0;
    for (std::size_t n = 0; n < profile.size(); ++n) {
      const Spring& s = body.network.springs[n];
      if (r.broken_at[n] > 0 || (body.nodes[s.i] && body.nodes[s.j])) continue;
      const Eigen::RowVector3d d = body.network.X.row(s.j) - body.network.X.row(s.i);
      const double elongation = d.normalized().dot(r.displacement.row(s.j) - r.displacement.row(s.i)) +
                                f.shrinkage * profile[n] * s.rest_length;
      stored += s.stiffness * elongation * elongation / 2;
      EXPECT_NEAR(r.stretch[n], elongation / s.rest_length, 1e-12);
    }
    EXPECT_NEAR(r.steps.back().stored, stored, 1e-12 * r.steps.back().work);
  }
}

TEST(Fracture, NoSpringIsLeftOverloaded) {
  const Held body = slab();
  const FractureResult r = run_fracture(body.network, body.nodes, drying(), 5);
  const std::vector<double> limits = thresholds(drying(), body.network.springs.size(), 5);
  for (std::size_t s = 0; s < limits.size(); ++s) EXPECT_LT(r.stretch[s], limits[s]);
}

TEST(Fracture, BreakingTogetherReleasesAsMuchAsOneByOne) {
  const Held body = slab();
  Fracture f = drying();
  const FractureResult together = run_fracture(body.network, body.nodes, f, 5);
  f.apart = 1e6;
  const FractureResult alone = run_fracture(body.network, body.nodes, f, 5);
  EXPECT_LT(together.solves, alone.solves);
  EXPECT_NEAR(together.released() / alone.released(), 1, 0.1);
}

TEST(Fracture, DriesFromTheTop) {
  Fracture f = drying();
  Network network = chain(2);
  network.X.row(1) << 0, 0, 3;
  EXPECT_DOUBLE_EQ(drying_profile(f, network)[0], std::exp(-1.0));
  f.depth = infinity;
  EXPECT_EQ(drying_profile(f, network)[0], 1);
}

TEST(Fracture, RefusesWhatIsOutOfRange) {
  const Held body = slab();
  const std::vector<char> none(body.nodes.size(), false);
  EXPECT_THROW(run_fracture(body.network, none, drying(), 1), std::invalid_argument);
  for (const auto spoil : {+[](Fracture& f) { f.threshold = 0; }, +[](Fracture& f) { f.scatter = -0.1; },
                           +[](Fracture& f) { f.shrinkage = 0.6; }, +[](Fracture& f) { f.steps = 0; },
                           +[](Fracture& f) { f.depth = 0; }, +[](Fracture& f) { f.apart = -1; }}) {
    Fracture f = drying();
    spoil(f);
    EXPECT_THROW(run_fracture(body.network, body.nodes, f, 1), std::invalid_argument);
  }
}

}  // namespace
}  // namespace springproof::fracture_test
