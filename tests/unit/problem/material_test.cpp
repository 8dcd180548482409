#include "problem/material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/tolerances.h"

namespace springproof::material_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Relative to `scale`, the size of the numbers it was computed from.
void expect_close(double value, double expected, double scale) {
  EXPECT_LE(std::abs(value - expected), test::round_off * std::abs(scale)) << value << " against " << expected;
}

std::string message_of(const Moduli& given, double density = 1000) {
  try {
    material_from(given, density);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Material, KnownSolid) {
  const IsotropicMaterial m{1e4, 0.25, 1000};
  EXPECT_DOUBLE_EQ(shear_modulus(m), 4000);
  EXPECT_DOUBLE_EQ(lame_lambda(m), 4000);
  EXPECT_DOUBLE_EQ(bulk_modulus(m), 20000.0 / 3);
  EXPECT_EQ(kappa(m), 0);
}

// Independent of E and nu: the identities that tie the moduli together.
TEST(Material, IdentitiesBetweenModuli) {
  for (const double nu : {-0.999, -0.5, 0.0, 0.1, 0.3, 0.4999}) {
    const IsotropicMaterial m{3e5, nu};
    const double G = shear_modulus(m), K = bulk_modulus(m), lambda = lame_lambda(m);
    expect_close(K, lambda + 2 * G / 3, K + G);
    expect_close(kappa(m), lambda - G, K + G);
    expect_close(m.youngs_modulus, 9 * K * G / (3 * K + G), m.youngs_modulus);
    EXPECT_EQ(kappa(m) < 0, nu < 0.25);
  }
}

TEST(Material, AllTenPairsGiveTheSameSolid) {
  std::optional<double> Moduli::*const members[] = {&Moduli::youngs_modulus, &Moduli::poisson_ratio,
                                                    &Moduli::shear_modulus, &Moduli::bulk_modulus,
                                                    &Moduli::lame_lambda};
  for (const double nu : {-0.9, -0.3, 0.1, 0.25, 0.45, 0.499}) {
    const IsotropicMaterial m{2e4, nu, 1200};
    const Moduli all{m.youngs_modulus, nu, shear_modulus(m), bulk_modulus(m), lame_lambda(m)};
    for (int a = 0; a < 5; ++a)
      for (int b = a + 1; b < 5; ++b) {
        Moduli pair;
        pair.*members[a] = all.*members[a];
        pair.*members[b] = all.*members[b];
        const IsotropicMaterial found = material_from(pair, 1200);
        SCOPED_TRACE(testing::Message() << "pair " << a << b << " nu " << nu);
        // The worst-conditioned pairs magnify round-off by K/G or G/K, below 1e3 here.
        EXPECT_NEAR(found.poisson_ratio, nu, 1e3 * std::numeric_limits<double>::epsilon());
        EXPECT_NEAR(found.youngs_modulus, 2e4, 2e4 * 1e4 * std::numeric_limits<double>::epsilon());
        EXPECT_EQ(found.density, 1200);
      }
  }
}

TEST(Material, PoissonRatioOutsideItsRangeIsRefused) {
  for (const double nu : {0.5, 0.6, -1.0, -2.0, nan, infinity, -infinity}) {
    const std::string message = message_of({1e4, nu, {}, {}, {}});
    EXPECT_NE(message.find("poisson_ratio = "), std::string::npos) << message;
    EXPECT_NE(message.find("-1 < poisson_ratio < 0.5"), std::string::npos) << message;
  }
  EXPECT_EQ(message_of({1e4, 0.5, {}, {}, {}}), "poisson_ratio = 0.5 (allowed: -1 < poisson_ratio < 0.5)");
}

TEST(Material, ModuliOutsideTheirRangeAreRefused) {
  for (const double bad : {0.0, -1.0, 1e-31, 1e31, 1e308, nan, infinity}) {
    EXPECT_NE(message_of({bad, 0.3, {}, {}, {}}).find("youngs_modulus > 0"), std::string::npos);
    EXPECT_NE(message_of({{}, 0.3, bad, {}, {}}).find("shear_modulus > 0"), std::string::npos);
    EXPECT_NE(message_of({{}, 0.3, {}, bad, {}}).find("bulk_modulus > 0"), std::string::npos);
    EXPECT_NE(message_of({1e4, 0.3, {}, {}, {}}, bad).find("density > 0"), std::string::npos);
  }
  EXPECT_EQ(message_of({1e308, 0.3, {}, {}, {}}),
            "youngs_modulus = 1e+308 Pa (allowed: youngs_modulus > 0, from 1e-30 to 1e+30 Pa)");
  for (const double bad : {nan, -1e31, infinity})
    EXPECT_NE(message_of({1e4, {}, {}, {}, bad}).find("lame_lambda = "), std::string::npos);
}

TEST(Material, PairsThatNoSolidHasAreRefused) {
  const Moduli impossible[] = {
      {3e4, {}, 1e4, {}, {}},   // E = 3 G: incompressible
      {9e4, {}, {}, 1e4, {}},   // E = 9 K: nu = -1
      {{}, 0.3, {}, {}, -1e4},  // lambda and nu of opposite sign
      {{}, 0.0, {}, {}, 0.0},   // lambda = 0 says nothing more than nu = 0
      {{}, 0.0, {}, {}, 1e4},   // lambda without nu
      {{}, {}, 1e4, {}, -7e3},  // K < 0
      {{}, {}, {}, 1e4, 1e4},   // G = 0
      {{}, {}, {}, 1e4, 2e4},   // G < 0
      {{}, {}, {}, 1e4, 3e4},   // division by zero
  };
  for (const Moduli& given : impossible) {
    const std::string message = message_of(given);
    EXPECT_NE(message.find("no elastic solid"), std::string::npos) << message;
    EXPECT_NE(message.find("-1 < poisson_ratio < 0.5"), std::string::npos) << message;
  }
}

TEST(Material, ExactlyTwoModuli) {
  EXPECT_NE(message_of({}).find("0 elastic moduli"), std::string::npos);
  EXPECT_NE(message_of({1e4, {}, {}, {}, {}}).find("1 elastic moduli"), std::string::npos);
  EXPECT_NE(message_of({1e4, 0.3, 1e3, {}, {}}).find("3 elastic moduli"), std::string::npos);
}

TEST(Material, CheckRefusesWhatTheHeaderSays) {
  EXPECT_NO_THROW(check({1, 0.49, 1}));
  EXPECT_THROW(check({0, 0.3, 1}), std::invalid_argument);
  EXPECT_THROW(check({1e308, 0.3, 1}), std::invalid_argument);
  EXPECT_THROW(check({1, 0.5, 1}), std::invalid_argument);
  EXPECT_THROW(check({1, nan, 1}), std::invalid_argument);
  EXPECT_THROW(check({1, 0.3, 0}), std::invalid_argument);
  EXPECT_THROW(check({1, 0.3, infinity}), std::invalid_argument);
}

}  // namespace
}  // namespace springproof::material_test
