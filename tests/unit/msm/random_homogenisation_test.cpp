// Disordered networks homogenised.  The expected numbers are those of an independent implementation (numpy, sparse direct
// solves, two seeds): Kot et al. (2014), set A, n = 1.29, minL = 0.8, a periodic box of side 10 with 1290 nodes.
#include <gtest/gtest.h>

#include <cmath>

#include "msm/calibrate.h"
#include "msm/measure/homogenise.h"
#include "msm/topology/random_network.h"
#include "problem/material.h"

namespace springproof {
namespace {

Network set_a(double springs_per_node, std::uint64_t seed) {
  RandomParameters p;
  p.spacing = std::cbrt(1 / 1.29);
  p.min_length = 0.8 / p.spacing;
  p.springs_per_node = springs_per_node;
  p.seed = seed;
  return periodic_random_network({10, 10, 10}, p);
}

struct Row {
  double springs_per_node, youngs_modulus, bulk_modulus, poisson_ratio, anisotropy;  // moduli over those of eqs. (20), (19)
};

// Eqs. (19), (20) take the strain as affine, so they are upper bounds; "within 5 % for <S> of 15 to 25" is no property of
// the bulk.  The means of ten networks must meet the independent figures within the difference of its two seeds, 0.01.
TEST(RandomNetworks, AreSofterThanEquation20ByTheIndependentFigures) {
  const int seeds = 10;
  for (const Row& row : {Row{10, 0.73, 0.81, 0.276, 0.03}, Row{15, 0.88, 0.89, 0.253, 0.02}, Row{22, 0.922, 0.930, 0.252, 0.008}}) {
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

// Near 1/2 the network relaxes the dispersed pressure away: "any Poisson's ratio" (Kot & Nagahashi 2015) does not hold there.
// Two seeds of the independent figures agree within 0.003.
TEST(RandomNetworks, DispersedMomentumMissesTheWantedPoissonRatio) {
  EXPECT_NEAR(poisson_ratio_of_emsm(12, -0.9, Dispersion::published), -0.882, 0.003);
  EXPECT_NEAR(poisson_ratio_of_emsm(12, 0.0, Dispersion::published), 0.040, 0.003);
  EXPECT_NEAR(poisson_ratio_of_emsm(12, 0.4, Dispersion::published), 0.387, 0.003);
  EXPECT_NEAR(poisson_ratio_of_emsm(22, -0.9, Dispersion::published), -0.893, 0.003);
  EXPECT_NEAR(poisson_ratio_of_emsm(22, 0.4, Dispersion::published), 0.393, 0.003);
  EXPECT_NEAR(poisson_ratio_of_emsm(12, 0.45, Dispersion::symmetric), 0.419, 0.003);
  EXPECT_NEAR(poisson_ratio_of_emsm(16, 0.45, Dispersion::symmetric), 0.425, 0.003);
  EXPECT_NEAR(poisson_ratio_of_emsm(22, 0.45, Dispersion::symmetric), 0.434, 0.003);
}

}  // namespace
}  // namespace springproof
