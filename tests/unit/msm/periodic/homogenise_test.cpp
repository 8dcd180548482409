#include "msm/periodic/homogenise.h"

#include <gtest/gtest.h>

#include <limits>

#include "msm/measure/statistics.h"
#include "msm/parameters/calibrate.h"
#include "msm/topology/cubic_lattice.h"
#include "support/periodic.h"
#include "support/tolerances.h"
#include "support/zoo.h"

namespace springproof::homogenise_test {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

double relative_difference(const Matrix6& C, const Matrix6& expected) {
  return (C - expected).norm() / expected.norm();
}

TEST(Homogenise, SpringsOfEveryPatternHaveLambdaAndMuEqualToG) {
  const double G = 3200;
  for (double A : {0.0, 0.25, 1.0, 2.0, test::infinity}) {
    Network network = test::periodic_cubes(isotropic_pattern(A));
    calibrate(G, network);
    const Homogenised h = homogenise({network, {Springs{}}});
    EXPECT_LE(relative_difference(h.C, isotropic_stiffness(5 * G / 3, G)), 1e-10) << "A = " << A;
    EXPECT_NEAR(h.poisson_ratio, 0.25, 1e-10);
    EXPECT_NEAR(h.youngs_modulus, 2.5 * G, 1e-10 * G);
    EXPECT_LE(h.anisotropy, 1e-10);
    EXPECT_LE(h.asymmetry, 1e-12);
  }
}

TEST(MakePeriodic, EveryNodeHasAllSpringsOfThePattern) {
  for (const auto& [A, springs] : {std::pair{0.0, 14}, {test::infinity, 18}, {2.0, 26}}) {
    const Network network = test::periodic_cubes(isotropic_pattern(A));
    const NetworkStatistics s = statistics(network);
    EXPECT_EQ(s.nodes, 27);
    EXPECT_NEAR(s.springs_per_node, springs, test::round_off);
    EXPECT_NEAR(s.spacing, 1, test::round_off);
    for (const double share : spring_shares(network)) EXPECT_NEAR(share, 1, test::round_off);
  }
}

// One cell, a node that is joined with its own images only, has the stiffness of many.
TEST(Homogenise, DoesNotDependOnTheNumberOfCells) {
  const auto of = [](int cells) {
    Network network = cubic_lattice(block_mesh(Vec3::Constant(cells), {cells, cells, cells}), {1.0, 0.7, 0.2});
    make_periodic(Vec3::Constant(cells), network);
    return homogenise({network, {Springs{}}}).C;
  };
  EXPECT_LE(relative_difference(of(1), of(4)), test::round_off * 10);
}

// Springs 1 and 3 in series along x have 2 k1 k3/(k1 + k3) per cell: an affine strain would give their mean.
TEST(Homogenise, RelaxesTheNodes) {
  Network network = cubic_lattice(block_mesh({2, 1, 1}, {2, 1, 1}), {1.0, 0, 0});
  make_periodic({2, 1, 1}, network);
  for (Spring& s : network.springs)
    if (std::abs(network.X(s.j, 0) - network.X(s.i, 0)) > 0.5 && std::min(network.X(s.i, 0), network.X(s.j, 0)) < 0.5)
      s.stiffness = 3;
  EXPECT_NEAR(homogenise({network, {Springs{}}}).C(0, 0), 2 * 3.0 / 4, test::round_off);
}

// Kot et al. (2014), sec. 3.2: "the second model" with k_C = 3/8 kappa has half the moduli that (14) and (15) say.
TEST(Homogenise, FourteenSpringsOfKotHaveHalfTheirModulus) {
  const Homogenised h = homogenise({test::periodic_cubes({1.0, 0, 3.0 / 8}), {Springs{}}});  // kappa = 1, a = 1
  EXPECT_NEAR(h.youngs_modulus, 1.25, 1e-12);
  EXPECT_NEAR(h.shear_modulus, 0.5, 1e-12);
  EXPECT_NEAR(h.poisson_ratio, 0.25, 1e-12);
  EXPECT_NEAR(homogenise({test::periodic_cubes({1.0, 1.0, 0}), {Springs{}}}).youngs_modulus, 2.5, 1e-12);  // (15)
}

TEST(Homogenise, HybMssIsTheIsotropicSolidForEveryPoissonRatioAndPattern) {
  for (double nu : {-0.9, -0.5, 0.0, 0.25, 0.4, 0.49, 0.499})
    for (double A : {0.25, 1.0, 2.0, 7.0}) {
      const IsotropicMaterial m{1e4, nu, 1000};
      Network network = test::periodic_cubes(isotropic_pattern(A));
      calibrate(shear_modulus(m), network);
      const Homogenised h = homogenise({network, {Springs{}, VolumeCorrection{kappa(m)}}});
      EXPECT_LE(relative_difference(h.C, isotropic_stiffness(bulk_modulus(m), shear_modulus(m))), 1e-8)
          << nu << ' ' << A;
      EXPECT_NEAR(h.poisson_ratio, nu, 1e-8);
      EXPECT_NEAR(h.youngs_modulus, 1e4, 1e-4);
    }
}

// Kot & Nagahashi (2015), eq. (9).  The operator and its transpose agree on the 18 lattice only.
TEST(Homogenise, CubicEmsmHasEquationNineInEveryForm) {
  for (double nu : {-0.9, -0.5, 0.0, 0.25, 0.4, 0.49, 0.499})
    for (auto form :
         {Dispersion::symmetric, Dispersion::share_weighted, Dispersion::published, Dispersion::published_transposed}) {
      const IsotropicMaterial m{1e4, nu, 1000};
      Network network = test::periodic_cubes(isotropic_pattern(test::infinity));
      calibrate(shear_modulus(m), network);
      const double q = dispersed_fraction(lame_lambda(m), shear_modulus(m));
      const Homogenised h = homogenise({network, {Springs{}, MomentumDispersion{q, form}}});
      EXPECT_LE(relative_difference(h.C, isotropic_stiffness(bulk_modulus(m), shear_modulus(m))), 1e-6) << nu;
      const double Q = 2 * q;
      EXPECT_NEAR(h.poisson_ratio, (1 + 5 * Q / 3) / (2 * (2 + 5 * Q / 3)), 1e-6);
    }
}

TEST(Homogenise, TransposedFormIsWrongOnFourteenSprings) {
  const auto poisson_ratio = [](double nu, Dispersion form) {
    const IsotropicMaterial m{1e4, nu, 1000};
    Network network = test::periodic_cubes(isotropic_pattern(0));
    calibrate(shear_modulus(m), network);
    return homogenise(
               {network, {Springs{}, MomentumDispersion{dispersed_fraction(lame_lambda(m), shear_modulus(m)), form}}})
        .poisson_ratio;
  };
  EXPECT_NEAR(poisson_ratio(0.0, Dispersion::published), 0.0, 1e-10);
  EXPECT_NEAR(poisson_ratio(0.0, Dispersion::published_transposed), -0.2, 1e-10);
  EXPECT_NEAR(poisson_ratio(0.4, Dispersion::published), 0.4, 1e-10);
  EXPECT_NEAR(poisson_ratio(0.4, Dispersion::published_transposed), 0.4146, 5e-5);
}

TEST(Homogenise, RefusesWhatHasNoImagesAndWhatIsUnstable) {
  Network network = cubic_lattice(block_mesh({2, 2, 2}, {2, 2, 2}), isotropic_pattern(2));
  EXPECT_THROW(homogenise({network, {Springs{}}}), std::invalid_argument);
  EXPECT_THROW(make_periodic({2, 2, 3}, network), std::invalid_argument);
  network = test::jiggled_periodic_cubes();
  for (Spring& s : network.springs) s.stiffness = -1;
  EXPECT_THROW(homogenise({network, {Springs{}}}), std::runtime_error);
}

// Kot et al. (2014), eqs. (10), (12); (13) with 6 beta/(k a^2), docs/papers.md.
TEST(HomogenisePlane, HexagonalLatticeWithAngularSprings) {
  const double k = 40, a = 0.3;
  Network network = test::periodic_triangles(4, 4, a, k);
  const Homogenised plain = homogenise({network, {Springs{}}});
  EXPECT_NEAR(plain.shear_modulus, 3 * k / (4 * std::sqrt(3.0)), 1e-10 * k);
  EXPECT_NEAR(plain.poisson_ratio, 1.0 / 3, 1e-10);
  for (double nu : {-0.95, -0.5, 0.0, 0.3, 0.6, 0.95}) {
    const double beta = angular_stiffness(k, a, nu), c = 6 * beta / (k * a * a);
    EXPECT_NEAR((1 - c) / (3 + c), nu, test::round_off);
    const Homogenised h = homogenise({network, {Springs{}, AngularSprings{beta}}});
    EXPECT_NEAR(h.poisson_ratio, nu, 1e-10);
    EXPECT_NEAR(h.bulk_modulus, 3 * k / (2 * std::sqrt(3.0)), 1e-10 * k) << "K_2D of (13) does not depend on beta";
    EXPECT_NEAR(h.youngs_modulus, 2 * h.bulk_modulus * (1 - nu), 1e-9 * k);
    EXPECT_LE(h.anisotropy, 1e-10);
  }
  EXPECT_THROW(angular_stiffness(k, a, 1.0), std::invalid_argument);
  EXPECT_THROW(angular_stiffness(k, a, -1.0), std::invalid_argument);
}

}  // namespace
}  // namespace springproof::homogenise_test
