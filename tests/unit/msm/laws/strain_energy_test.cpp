// The strain curves of a cell against the material laws that they stand for.  Derivatives, objectivity: the law suite.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "msm/laws/strain_energy.h"
#include "support/zoo.h"

namespace springproof::strain_energy_test {
namespace {

constexpr double G = 3;

/// A deformation gradient of these principal stretches, in a frame askew to the axes.
Eigen::Matrix3d turned(const Vec3& stretch) {
  const Eigen::Matrix3d frame = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  return test::rotation() * frame * stretch.asDiagonal() * frame.transpose();
}

// W of springs (lambda = G) by the principal stretches.

double hencky(const Vec3& stretch) {
  const Vec3 e = stretch.array().log();
  return G * e.squaredNorm() + G / 2 * e.sum() * e.sum();
}

double neo_hooke(const Vec3& stretch) {
  const double e = std::log(stretch.prod());
  return G / 2 * (stretch.squaredNorm() - 3 - 2 * e) + G / 2 * e * e;
}

double neo_hooke_isochoric(const Vec3& stretch) {
  const double J = stretch.prod();
  return G / 2 * (stretch.squaredNorm() / std::cbrt(J * J) - 3) + 5 * G / 6 * (J - 1) * (J - 1);
}

/// Largest difference of the principal Kirchhoff stresses from those of a law, dW / d ln stretch, over the largest.
template <class Law>
double stress_error(StrainCurve curve, const Law& law, const Vec3& stretch) {
  const Eigen::Matrix3d F = turned(stretch);
  const Eigen::Matrix3d tau = springs_energy(curve, G, F, Derivative::first).stress * F.transpose();
  Vec3 expected;
  const double h = 1e-5;
  for (int i = 0; i < 3; ++i) {
    Vec3 more = stretch, less = stretch;
    more[i] *= std::exp(h);
    less[i] *= std::exp(-h);
    expected[i] = (law(more) - law(less)) / (2 * h);
  }
  const Vec3 found = tau.selfadjointView<Eigen::Lower>().eigenvalues();
  std::sort(expected.data(), expected.data() + 3);
  return (found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

const std::vector<Vec3> up_to_20 = {{1.2, 0.95, 0.93}, {0.8, 1.1, 1.07}, {1.2, 0.83, 1.0}, {1.1, 1.1, 0.85}};

TEST(StrainEnergy, EdgesOfRestLengthZeroAreNeoHooke) {
  for (const Vec3& stretch : {Vec3(1.2, 0.95, 0.93), Vec3(2, 0.6, 0.7)}) {
    EXPECT_LE(stress_error(StrainCurve::neo_hooke, neo_hooke, stretch), 1e-8);
    EXPECT_LE(stress_error(StrainCurve::neo_hooke_isochoric, neo_hooke_isochoric, stretch), 1e-8);
  }
}

TEST(StrainEnergy, LengthsAreasAndVolumeAreHencky) {
  for (const Vec3& stretch : up_to_20) EXPECT_LE(stress_error(StrainCurve::hencky, hencky, stretch), 3e-4);
  EXPECT_LE(stress_error(StrainCurve::hencky, hencky, Vec3(1.5, 0.85, 0.8)), 0.006);
  EXPECT_LE(stress_error(StrainCurve::hencky, hencky, Vec3(0.6, 1.25, 1.2)), 0.006);
}

// Thirteen directions are isotropic up to second order; beyond, the stress depends on the frame.
TEST(StrainEnergy, ThirteenSpringsFollowTheirLawAtModerateStrain) {
  for (const Vec3& stretch : up_to_20) {
    EXPECT_LE(stress_error(StrainCurve::springs_hencky, hencky, stretch), 0.1);
    EXPECT_LE(stress_error(StrainCurve::springs_neo_hooke, neo_hooke_isochoric, stretch), 0.05);
    const Vec3 a_quarter = (0.25 * stretch.array().log()).exp();
    EXPECT_LE(stress_error(StrainCurve::springs_hencky, hencky, a_quarter), 0.008);
    EXPECT_LE(stress_error(StrainCurve::springs_neo_hooke, neo_hooke_isochoric, a_quarter), 0.005);
  }
}

TEST(StrainEnergy, SmallStrainsHaveTheModuliOfSprings) {
  const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d strain;
  strain << 1, 0.3, -0.2, 0.3, -0.5, 0.4, -0.2, 0.4, 0.2;
  const Eigen::Matrix3d expected = 2 * G * strain + G * strain.trace() * none;
  for (int curve = 0; curve < 5; ++curve) {
    const StrainEnergy W = springs_energy(static_cast<StrainCurve>(curve), G, none, Derivative::second);
    EXPECT_LE(W.stress.norm(), 1e-14 * G);
    const Eigen::Matrix<double, 9, 1> stress = W.tangent * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(strain.data());
    EXPECT_LE((Eigen::Map<const Eigen::Matrix3d>(stress.data()) - expected).norm(), 1e-13 * expected.norm()) << curve;
    const VolumeDensity U = volume_term(static_cast<StrainCurve>(curve), 1);
    EXPECT_EQ(U.slope, 0);
    EXPECT_EQ(U.curvature, 1);
  }
}

}  // namespace
}  // namespace springproof::strain_energy_test
