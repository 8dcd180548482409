// Period and amplitude of recorded vibrations.
#include "comparisons/judge/swings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace springproof::swings_test {
namespace {

constexpr double pi = std::numbers::pi;

std::optional<Swings> of(double duration, int samples, double (*u)(double t)) {
  std::vector<double> time, value;
  for (int i = 0; i < samples; ++i) {
    time.push_back(duration * i / (samples - 1));
    value.push_back(u(time.back()));
  }
  return swings_of(time, value);
}

TEST(Swings, PeriodAmplitudeAndMeanOfACosine) {
  const auto s = of(7.3, 700, [](double t) { return 3 - 0.2 * std::cos(2 * pi * t / 1.7); });
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->period, 1.7, 1e-3);
  EXPECT_NEAR(s->amplitude, 0.2, 1e-4);
  EXPECT_NEAR(s->mean, 3, 2e-3);
}

TEST(Swings, ASmallSecondModeAddsNoSwings) {
  const auto s = of(20, 2000, [](double t) { return std::sin(2 * pi * t) + 0.07 * std::sin(2 * pi * 9.3 * t); });
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->period, 1, 5e-3);
}

TEST(Swings, TooFewSwingsOrSamplesGiveNothing) {
  EXPECT_FALSE(of(2, 200, [](double t) { return std::sin(2 * pi * t); }));   // one upward crossing to the next
  EXPECT_FALSE(of(20, 100, [](double t) { return std::sin(2 * pi * t); }));  // five samples to a swing
  EXPECT_FALSE(of(2, 200, [](double) { return 1.0; }));
}

TEST(Arrival, IsWhereATenthOfTheLargestDepartureIsReached) {
  const std::vector<double> time = {0, 1, 2, 3, 4};
  EXPECT_NEAR(*arrival_of(time, {5, 5, 5.2, 4, 5}), 1.5, 1e-12);
  EXPECT_FALSE(arrival_of(time, {5, 5, 5, 5, 5}));
}

/// A damped cosine of period 1 about a place of rest, with an overtone that dies faster; ten swings.
std::optional<DampedSwings> damped(double ratio, double rest, double overtone) {
  std::vector<double> time, value;
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.01 * i, d = ratio / std::sqrt(1 - ratio * ratio) * 2 * pi;
    time.push_back(t);
    value.push_back(rest + std::exp(-d * t) * std::cos(2 * pi * t) +
                    overtone * std::exp(-2 * d * t) * std::cos(6.3 * 2 * pi * t));
  }
  const auto swings = swings_of(time, value);
  return swings ? damped_swings_of(time, value, *swings) : std::nullopt;
}

TEST(Swings, TellTheDamping) {
  for (const double ratio : {0.0, 0.01, 0.05, 0.1})
    for (const double rest : {0.0, 0.1}) {
      const auto swings = damped(ratio, rest, 0);
      ASSERT_TRUE(swings) << ratio;
      EXPECT_NEAR(swings->damping_ratio, ratio, 1e-7);
      EXPECT_NEAR(swings->period, 1, 1e-7);
    }
  EXPECT_FALSE(damped(0.2, 0, 0));  // a second swing of less than a tenth of the first deflection
}

TEST(Swings, OvertonesHaveLittlePartInTheDamping) {
  for (const double ratio : {0.01, 0.05, 0.1}) {
    const auto swings = damped(ratio, 0.1, 0.1);
    ASSERT_TRUE(swings) << ratio;
    EXPECT_NEAR(swings->damping_ratio, ratio, 0.01 * ratio);
    EXPECT_NEAR(swings->period, 1, 1e-3);
  }
}

}  // namespace
}  // namespace springproof::swings_test
