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

TEST(StressError, ComparesInvariantsThatTurnsOfTheAxesLeave) {
  ProbeStresses stress(2, 6);
  stress << 5, -1, -1, 0, 0, 0,  // tension of 6 in a pressure of 1, and the same along (1, 1, 1)
      1, 1, 1, 2, 2, 2;
  NodalVectors expected(2, 3);
  expected << 6, 1, 5, 6, 1, 5;
  EXPECT_TRUE(invariants(stress).isApprox(expected, 1e-12)) << invariants(stress);
}

TEST(StressError, WeighsPointsByTheirVolumesAndTakesThePeakOfAll) {
  // The third point lies on the surface: it counts for the peak alone.
  const Eigen::Vector3d volumes(1, 3, 0);
  const StressLimit limit = stress_limit({tension({3, 1, 4}), tension({3, 1, 4}), tension({3, 1, 4})}, volumes);
  EXPECT_EQ(limit.place, 2);
  EXPECT_NEAR(limit.peak.value, 4, 1e-6);
  const NodalVectors off = invariants(tension({3, 2, 5})) - limit.of_points;
  EXPECT_TRUE(stress_errors(off, limit, volumes).isApproxToConstant(0.5, 1e-6));
}

TEST(StressError, OfPressureIsRelativeToATenthOfVonMisesWhereThereIsLittle) {
  ProbeStresses shear = ProbeStresses::Zero(2, 6);
  shear.col(3).setConstant(1);
  ProbeStresses pressed = shear;
  pressed.leftCols<3>().setConstant(-0.01);
  const Eigen::Vector2d volumes(1, 2);
  const StressLimit limit = stress_limit({shear, shear, shear}, volumes);
  const Eigen::Vector3d errors = stress_errors(invariants(pressed) - limit.of_points, limit, volumes);
  EXPECT_NEAR(errors[0], 0, 1e-6);
  EXPECT_NEAR(errors[1], 0.01 / (0.1 * std::sqrt(3)), 1e-6);
  EXPECT_NEAR(errors[2], 0.01, 1e-6);  // of the principal stress, 1
}

TEST(StressError, ReferenceIsTheLimitOfEachInvariantWithItsUncertainty) {
  const auto on_grid = [](double h) { return tension({3 + h * h, 1 - 2 * h * h}); };
  const Eigen::Vector2d volumes(1, 1);
  const StressLimit limit = stress_limit({on_grid(0.4), on_grid(0.2), on_grid(0.1)}, volumes);
  EXPECT_TRUE(limit.of_points.isApprox(invariants(tension({3, 1})), 1e-6)) << limit.of_points;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(limit.fields[k].observed_order.value_or(0), 2, 1e-6);
    EXPECT_GE(limit.fields[k].nodal_uncertainty[1], 0.02 / (k == 1 ? 3 : 1));  // the finest grid's error
  }
  EXPECT_NEAR(limit.peak.value, 3, 1e-6);
}

TEST(StressError, OfMeshesThatAreNotNestedIsUncertainByTheLastDifference) {
  // Each mesh has errors of its own, smaller from one to the next.
  const StressLimit limit =
      stress_limit({tension({3.3, 1, 2}), tension({3, 1.15, 2}), tension({3, 1, 2.1})}, Eigen::Vector3d::Ones());
  EXPECT_LT(limit.fields[0].correlation.value_or(1), 0.5);
  EXPECT_TRUE(limit.of_points.col(0).isApprox(Eigen::Vector3d(3, 1, 2.1), 1e-12));
  EXPECT_TRUE(limit.fields[0].nodal_uncertainty.isApprox(1.25 * Eigen::Vector3d(0.3 / 4, 0.15, 0.1), 1e-6))
      << limit.fields[0].nodal_uncertainty;
}

TEST(StressError, PeaksAtASingularEdgeHaveNoLimit) {
  const auto singular = [](double coarse, double middle, double fine) {
    const Eigen::Matrix<double, 1, 1> volume(1.0);
    return stress_limit({tension({coarse}), tension({middle}), tension({fine})}, volume).peak_is_singular();
  };
  EXPECT_FALSE(singular(1, 1.5, 1.75));
  EXPECT_FALSE(singular(1, 1.001, 1.009));      // however it came about
  EXPECT_FALSE(singular(1, 1.3, 1.15));         // it does not grow
  EXPECT_TRUE(singular(1, std::sqrt(2.0), 2));  // as r^(-1/2)
  EXPECT_TRUE(singular(1, 1.5, 2));             // as a logarithm
}

}  // namespace
}  // namespace springproof::stress_error_test
