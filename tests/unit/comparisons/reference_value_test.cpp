#include "comparisons/reference_value.h"

#include <gtest/gtest.h>

#include <cmath>

namespace springproof {
namespace {

std::vector<double> sequence(double limit, double error, double order) {
  return {limit + error, limit + error / std::pow(2, order), limit + error / std::pow(4, order)};
}

TEST(ReferenceValue, RecoversLimitAndOrder) {
  for (double order : {0.7, 1.4, 2.0}) {
    const ReferenceValue v = extrapolate(sequence(7.5, -0.3, order), 1e-12);
    ASSERT_TRUE(v.observed_order);
    EXPECT_NEAR(*v.observed_order, order, 1e-9);
    EXPECT_NEAR(v.value, 7.5, 1e-9);
    // GCI: Fs times the finest grid's own error
    EXPECT_NEAR(v.uncertainty, 1.25 * 0.3 / std::pow(4, order), 1e-9);
  }
}

TEST(ReferenceValue, RecoversLimitAndOrderOnGridsOfAnyRatios) {
  for (const GridRatios r : {GridRatios{1.5, 1.5}, GridRatios{1.3, 1.7}, GridRatios{2, 1.2}}) {
    const double p = 1.6, h3 = 0.1, h2 = r.fine * h3, h1 = r.coarse * h2;
    const auto f = [&](double h) { return 7.5 - 3 * std::pow(h, p); };
    const ReferenceValue v = extrapolate({f(h1), f(h2), f(h3)}, 1e-12, {}, r);
    ASSERT_TRUE(v.observed_order);
    EXPECT_NEAR(*v.observed_order, p, 1e-9);
    EXPECT_NEAR(v.value, 7.5, 1e-9);
    EXPECT_NEAR(v.uncertainty, 1.25 * 3 * std::pow(h3, p), 1e-9);
  }
}

TEST(ReferenceValue, TwoGridsAreOfFirstOrder) {
  const ReferenceValue v = extrapolate_two(1 + 0.4, 1 + 0.2);
  EXPECT_NEAR(v.value, 1, 1e-15);
  EXPECT_NEAR(v.uncertainty, 3 * 0.2, 1e-15);
  EXPECT_FALSE(v.observed_order);
}

TEST(ReferenceValue, DoesNotTrustHighOrders) {
  // Two grids that happen to agree look like a high order: torsion at nu = 0.499 showed 5.4 on grids up to 8^3, and was
  // off by 27 times an uncertainty that believed it.
  const ReferenceValue v = extrapolate(sequence(1, 0.1, 5), 0);
  EXPECT_NEAR(*v.observed_order, 5, 1e-6);
  const double last = 0.1 / 32 - 0.1 / 1024;
  EXPECT_NEAR(v.uncertainty, 1.25 * last, 1e-12);
  // Between 2 and 2.5 the order is taken as 2.
  const double fine = 0.1 * (std::pow(2, -2.3) - std::pow(4, -2.3));
  EXPECT_NEAR(extrapolate(sequence(1, 0.1, 2.3), 0).uncertainty, 1.25 * fine / 3, 1e-12);
}

TEST(ReferenceValue, TrustsTheElementsOrderInASmoothSolution) {
  const auto fine = [](double order) { return 0.1 * (std::pow(2, -order) - std::pow(4, -order)); };
  const auto uncertainty = [](double order, const std::string& measure, const std::string& element) {
    return extrapolate(sequence(1, 0.1, order), 0, trusted_order(measure, element, true)).uncertainty;
  };
  const std::string u = "displacement.tip.x", stress = "stress.tip.xx";
  EXPECT_NEAR(uncertainty(3, u, "q2"), 1.25 * 0.1 / 64, 1e-12);
  EXPECT_NEAR(uncertainty(4, u, "q2"), 1.25 * fine(4) / 7, 1e-12);       // at nodes: not believed, yet not suspicious
  EXPECT_NEAR(uncertainty(4.6, u, "q2"), 1.25 * fine(4.6), 1e-12);
  EXPECT_NEAR(uncertainty(3, stress, "p2"), 1.25 * fine(3) / 3, 1e-12);
  EXPECT_NEAR(uncertainty(2, u, "p1"), 1.25 * 0.1 / 16, 1e-12);
  EXPECT_NEAR(uncertainty(2, stress, "q1"), 1.25 * fine(2), 1e-12);
  EXPECT_NEAR(uncertainty(2.6, u, "q1"), 1.25 * fine(2.6), 1e-12);
  EXPECT_NEAR(uncertainty(3, "volume_change", "q2"), 1.25 * fine(3), 1e-12);
}

TEST(ReferenceValue, SmoothnessMustBeStated) {
  for (const char* measure : {"displacement.tip.x", "stress.tip.xx", "volume_change"}) {
    const TrustedOrder trusted = trusted_order(measure, "q2", false);
    EXPECT_EQ(trusted.highest, 2);
    EXPECT_EQ(trusted.suspicious, 2.5);
  }
}

TEST(ReferenceValue, SlowConvergenceIsNotExtrapolated) {
  const ReferenceValue v = extrapolate(sequence(1, 0.1, 0.2), 0);
  EXPECT_FALSE(v.observed_order);
  EXPECT_GE(v.uncertainty, 0.25 * 0.1 / std::pow(4, 0.2));
}

TEST(ReferenceValue, SaysWhenItIsNotMonotone) {
  for (const std::vector<double>& values : {std::vector<double>{1, 2, 1.5}, {1, 1.1, 1.3}}) {
    const ReferenceValue v = extrapolate(values, 0);
    EXPECT_FALSE(v.observed_order);
    EXPECT_EQ(v.value, values.back());
    EXPECT_GE(v.uncertainty, *std::max_element(values.begin(), values.end()) -
                                 *std::min_element(values.begin(), values.end()));
  }
}

TEST(ReferenceValue, RoundOffIsNotAnOrder) {
  const ReferenceValue v = extrapolate({5.0, 5.0 + 1e-10, 5.0 - 1e-10}, 1e-9);
  EXPECT_FALSE(v.observed_order);
  EXPECT_EQ(v.uncertainty, 1e-9);
}

TEST(ReferenceValue, NeedsThreeGrids) {
  EXPECT_THROW(extrapolate({1, 2}, 0), std::invalid_argument);
}

TEST(ReferenceField, RecoversTheLimitField) {
  const NodalVectors limit = NodalVectors::Random(50, 3), error = 0.1 * NodalVectors::Random(50, 3);
  const Eigen::VectorXd weights = Eigen::VectorXd::Random(50).cwiseAbs() + Eigen::VectorXd::Ones(50);
  const ReferenceField f =
      extrapolate(std::vector<NodalVectors>{limit + error, limit + error / 4, limit + error / 16}, weights);
  EXPECT_NEAR(*f.observed_order, 2, 1e-9);
  EXPECT_LE((f.displacement - limit).norm(), 1e-12);
  EXPECT_NEAR(f.uncertainty,
              1.25 * weighted_norm(error, weights) / 16 / weighted_norm(limit + error / 16, weights) + 1e-8, 1e-9);
}

}  // namespace
}  // namespace springproof
