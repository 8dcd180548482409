// Disordered networks homogenised.  The expected numbers are those of an independent implementation (numpy, sparse
// direct solves, two seeds): Kot et al. (2014), set A, n = 1.29, minL = 0.8, a periodic box of side 10 with 1290 nodes.
#include <gtest/gtest.h>

#include <cmath>

#include "msm/measure/local_fields.h"
#include "msm/parameters/calibrate.h"
#include "msm/periodic/homogenise.h"
#include "msm/statics/equilibrium.h"
#include "msm/topology/random/random_network.h"
#include "problem/material.h"

namespace springproof::random_homogenisation_test {
namespace {

RandomParameters set_a_parameters(double springs_per_node, std::uint64_t seed) {
  RandomParameters p{};
  p.spacing = std::cbrt(1 / 1.29);
  p.min_length = 0.8 / p.spacing;
  p.springs_per_node = springs_per_node;
  p.seed = seed;
  return p;
}

Network set_a(double springs_per_node, std::uint64_t seed) {
  return periodic_random_network({10, 10, 10}, set_a_parameters(springs_per_node, seed));
}

struct Row {
  double springs_per_node, youngs_modulus, bulk_modulus, poisson_ratio,
      anisotropy;  // moduli over those of eqs. (20), (19)
};

// Eqs. (19), (20) take the strain as affine, so they are upper bounds; "within 5 % for <S> of 15 to 25" is no property
// of the bulk.  The means of ten networks must meet the independent figures within the difference of its two seeds,
// 0.01.
TEST(RandomNetworks, AreSofterThanEquation20ByTheIndependentFigures) {
  const int seeds = 10;
  for (const Row& row :
       {Row{10, 0.73, 0.81, 0.276, 0.03}, Row{15, 0.88, 0.89, 0.253, 0.02}, Row{22, 0.922, 0.930, 0.252, 0.008}}) {
    double E = 0, K = 0, nu = 0, anisotropy = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      Network network = set_a(row.springs_per_node, seed);
      calibrate(0.4, network);  // E = 1 by (20), K = 2/3 by (19)
      const Homogenised h = homogenise({network, {Springs{}}});
      EXPECT_LT(h.youngs_modulus, 1) << "seed " << seed;
      EXPECT_LT(h.asymmetry, 1e-9);
      E += h.youngs_modulus / seeds;
      K += 1.5 * h.bulk_modulus / seeds;
      nu += h.poisson_ratio / seeds;
      anisotropy += h.anisotropy / seeds;
    }
    EXPECT_NEAR(E, row.youngs_modulus, 0.01) << row.springs_per_node;
    EXPECT_NEAR(K, row.bulk_modulus, 0.01) << row.springs_per_node;
    EXPECT_NEAR(nu, row.poisson_ratio, 0.004) << row.springs_per_node;
    EXPECT_LT(anisotropy, 2 * row.anisotropy) << row.springs_per_node;
  }
}

double poisson_ratio_of_emsm(double springs_per_node, double wanted, Dispersion form) {
  Network network = set_a(springs_per_node, 1);
  const IsotropicMaterial m{1, wanted, 1};
  calibrate(shear_modulus(m), network);
  const double q = dispersed_fraction(lame_lambda(m), shear_modulus(m));
  return homogenise({network, {Springs{}, MomentumDispersion{q, form}}}).poisson_ratio;
}

// Near 1/2 the network relaxes the dispersed pressure away: "any Poisson's ratio" (Kot & Nagahashi 2015) does not hold
// there. Two seeds of the independent figures agree within 0.003.
TEST(RandomNetworks, DispersedMomentumMissesTheWantedPoissonRatio) {
  EXPECT_NEAR(poisson_ratio_of_emsm(12, -0.9, Dispersion::published), -0.882, 0.003);
  EXPECT_NEAR(poisson_ratio_of_emsm(12, 0.4, Dispersion::published), 0.387, 0.003);
  EXPECT_NEAR(poisson_ratio_of_emsm(22, 0.4, Dispersion::published), 0.393, 0.003);
  EXPECT_NEAR(poisson_ratio_of_emsm(12, 0.45, Dispersion::symmetric), 0.419, 0.003);
  EXPECT_NEAR(poisson_ratio_of_emsm(22, 0.45, Dispersion::symmetric), 0.434, 0.003);
}

/// Kot et al. (2014), sec. 5.1: x prescribed on all nodes within 1.5 maxL of both ends, nothing else.
struct GrippedBlock {
  Vec3 size;
  double grip = 0;  ///< 1.5 maxL [m]
  MassSpringModel model;
  NodalVectors u;

  double elongation() const { return 0.01 * size[0]; }

  GrippedBlock(const Vec3& block_size, std::uint64_t seed) : size(block_size) {
    RandomParameters p = set_a_parameters(15, seed);
    p.surface_nodes = false;
    Network network = random_network(region_of(block_mesh(size, {2, 2, 2})), p);
    network.volume *= size.prod() / network.volume.sum();
    calibrate(0.4, network);
    for (const Spring& s : network.springs) grip = std::max(grip, 1.5 * s.rest_length);
    model = {network, {Springs{}}};
    const Equilibrium e = solve_linear(model, conditions());
    EXPECT_TRUE(e.ok) << e.message;
    u = e.displacement;
  }

  BoundaryConditions conditions() const {
    const NodalVectors& X = model.network.X;
    const Eigen::Index n = X.rows();
    BoundaryConditions bc{std::vector<char>(3 * n, 0), std::vector<int>(3 * n, -1), NodalVectors::Zero(n, 3),
                          NodalVectors::Zero(n, 3)};
    const auto hold = [&](Eigen::Index unknown) { bc.fixed[unknown] = 1, bc.owner[unknown] = 0; };
    Eigen::Index low = 0, high = 0;  // two held nodes far apart along y
    for (Eigen::Index i = 0; i < n; ++i) {
      if (X(i, 0) > grip && X(i, 0) < size[0] - grip) continue;
      hold(3 * i);
      if (X(i, 0) > grip) bc.prescribed(i, 0) = elongation();
      if (X(i, 1) < X(low, 1)) low = i;
      if (X(i, 1) > X(high, 1)) high = i;
    }
    for (const Eigen::Index unknown : {3 * low + 1, 3 * low + 2, 3 * high + 2}) hold(unknown);  // no rigid motion
    return bc;
  }
};

// A block seems to have the modulus of (20): its grips shorten the length that stretches.  Over the local strain it is
// as soft as the infinite network, a little harder for the surface, whose missing springs (20) does not count.
TEST(RandomNetworks, GripsOfABlockHideItsSoftness) {
  const Vec3 size(36, 9, 9);
  const int seeds = 10;
  double nominal = 0, local = 0, nu = 0, nu_of_fields = 0, as_printed = 0, gauge = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const GrippedBlock block(size, seed);
    const BlockModuli m = measure_block(block.model, block.u, {Vec3::Zero(), size, block.elongation()}, 2.0);
    nominal += m.youngs_modulus_nominal / seeds;
    local += m.youngs_modulus_local / seeds;
    nu += m.poisson_ratio / seeds;
    nu_of_fields += m.poisson_ratio_of_fields / seeds;
    as_printed += m.poisson_ratio_as_printed / seeds;
    gauge += size[0] / (size[0] - 2 * block.grip) / seeds;
  }
  EXPECT_NEAR(nominal / local, gauge, 0.03);  // where a grip ends is known to half a node distance
  EXPECT_GT(nominal, 0.95);
  EXPECT_LT(local, 0.95);
  // The spread of one network is 0.004.
  EXPECT_NEAR(nu, 0.25, 0.006);
  EXPECT_NEAR(nu_of_fields, 0.25, 0.006);
  EXPECT_NEAR(as_printed, 0.25 / 1.25, 0.01);
}

}  // namespace
}  // namespace springproof::random_homogenisation_test
