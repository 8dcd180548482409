// Plane waves of infinite lattices.
#include <gtest/gtest.h>

#include <numbers>

#include "msm/measure/waves.h"
#include "support/zoo.h"

namespace springproof::waves_test {
namespace {

MassSpringModel lattice(const char* name, double nu = 0.25) {
  return build_model(test::model(name), block_mesh({1, 1, 1}, {4, 4, 4}), {2 * (1 + nu), nu, 1});  // G = 1
}

VelocityError error_of(const char* name, double cells, double consistent, double nu = 0.25) {
  return wave_errors(lattice(name, nu), 1, 2 * nu / (1 - 2 * nu), cells, consistent).phase;
}

TEST(Waves, VelocitiesConvergeWithOrderTwo) {
  for (const char* name : {"hybmss", "hybmss_bt", "hybmss_avg", "msm_18"}) {
    const VelocityError coarse = error_of(name, 20, 0), fine = error_of(name, 40, 0);
    EXPECT_NEAR(coarse.longitudinal / fine.longitudinal, 4, 0.05) << name;
    EXPECT_NEAR(coarse.transverse / fine.transverse, 4, 0.05) << name;
  }
}

// omega = c k (1 + a k^2): the phase velocity is off by a k^2, the group velocity by 3 a k^2.
TEST(Waves, APulseIsOffThreeTimesAsMuchAsItsCrestsAndWithTheSameOrder) {
  for (const char* name : {"hybmss", "hybmss_bt", "hybmss_avg"})
    for (const double consistent : {0.0, 1.0}) {
      const auto errors = [&](double cells) { return wave_errors(lattice(name), 1, 1, cells, consistent); };
      const WaveErrors coarse = errors(40), fine = errors(80);
      EXPECT_NEAR(coarse.group.longitudinal / fine.group.longitudinal, 4, 0.05) << name;
      EXPECT_NEAR(coarse.group.transverse / fine.group.transverse, 4, 0.05) << name;
      EXPECT_NEAR(fine.group.longitudinal / fine.phase.longitudinal, 3, 0.02) << name;
      EXPECT_NEAR(fine.group.transverse / fine.phase.transverse, 3, 0.02) << name;
    }
}

// A wave along the axis: omega = 2 sqrt(K / m) sin(k / 2) / ..., whose slope is c cos(k / 2).
TEST(Waves, APulseAlongAnAxisHasTheSlopeOfTheChain) {
  const double k = 2 * std::numbers::pi / 10;
  const WaveErrors e = wave_errors(lattice("hybmss_avg"), 1, 1, 10, 0);
  EXPECT_LT(e.group.longitudinal, std::cos(k / 2) - 1 + 1e-12);  // the worst direction is no better
  EXPECT_GT(e.group.longitudinal, 3 * (std::cos(k / 2) - 1));
}

// Along an axis a lattice of springs is a chain, omega = 2 sqrt(k/m) sin(k l / 2): the worst direction is no better.
TEST(Waves, AreInTheWorstDirectionSlowerThanInAChain) {
  const double wave = 2 * std::numbers::pi / 10;
  const VelocityError e = error_of("hybmss_bt", 10, 0);
  EXPECT_LT(e.longitudinal, std::sin(wave / 2) / (wave / 2) - 1 + 1e-12);  // the worst direction is worse
  const VelocityError half = error_of("hybmss_bt", 10, 0.5);
  EXPECT_LT(std::abs(half.transverse), 0.5 * std::abs(e.transverse));
}

TEST(Waves, MassesOnCornersAreSlowAndConsistentOnesFast) {
  for (double nu : {-0.5, 0.0, 0.25, 0.45}) {
    EXPECT_LT(error_of("hybmss_avg", 10, 0, nu).longitudinal, 0) << nu;
    EXPECT_GT(error_of("hybmss_avg", 10, 1, nu).longitudinal, 0) << nu;
  }
}

TEST(Waves, WithoutFaceDiagonalsOneHasNoEnergy) {
  const SoftestWave none = softest_wave(lattice("hybmss_fd", 0.3), 1), some = softest_wave(lattice("hybmss", 0.3), 1);
  EXPECT_NEAR(none.stiffness, 0, 1e-12);
  EXPECT_GT(some.stiffness, 0.5);
  EXPECT_GT(softest_wave(lattice("hybmss_avg", -0.5), 1).stiffness, 0.1);
}

TEST(Waves, NetworksWithoutCellsAreRefused) { EXPECT_THROW(softest_wave(lattice("emsm"), 1), std::invalid_argument); }

}  // namespace
}  // namespace springproof::waves_test
