#include "comparisons/judge/stress_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace springproof::stress_error_test {
namespace {

/// Tension along x [Pa] at each point.
ProbeStresses tension(const std::vector<double>& along_x) {
  ProbeStresses stress = ProbeStresses::Zero(static_cast<Eigen::Index>(along_x.size()), 6);
  for (std::size_t i = 0; i < along_x.size(); ++i) stress(static_cast<Eigen::Index>(i), 0) = along_x[i];
  return stress;
}

TEST(StressError, WeighsPointsByTheirVolumesAndTakesThePeakOfAll) {
  // The third point lies on the surface: it counts for the peak alone.
  const StressDifference d = stress_difference(tension({3, 2, 5}), tension({3, 1, 4}), Eigen::Vector3d(1, 3, 0));
  EXPECT_NEAR(d.von_mises, 0.5, 1e-6);
  EXPECT_NEAR(d.hydrostatic, 0.5, 1e-6);
  EXPECT_NEAR(d.peak, 0.25, 1e-6);
  EXPECT_EQ(d.place, 2);
}

TEST(StressError, OfPressureIsRelativeToATenthOfVonMisesWhereThereIsLittle) {
  ProbeStresses shear = ProbeStresses::Zero(2, 6);
  shear.col(3).setConstant(1);
  ProbeStresses pressed = shear;
  pressed.leftCols<3>().setConstant(-0.01);
  const StressDifference d = stress_difference(pressed, shear, Eigen::Vector2d(1, 2));
  EXPECT_NEAR(d.von_mises, 0, 1e-6);
  EXPECT_NEAR(d.hydrostatic, 0.01 / (0.1 * std::sqrt(3)), 1e-6);
}

TEST(StressError, PeaksAtASingularEdgeHaveNoLimit) {
  EXPECT_TRUE(peaks_converge(1, 1.5, 1.75));
  EXPECT_TRUE(peaks_converge(1, 1.001, 1.009));        // however it came about
  EXPECT_FALSE(peaks_converge(1, std::sqrt(2.0), 2));  // as r^(-1/2)
  EXPECT_FALSE(peaks_converge(1, 1.5, 2));             // as a logarithm
}

}  // namespace
}  // namespace springproof::stress_error_test
