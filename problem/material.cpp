#include "problem/material.h"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

namespace springproof {
namespace {

// Of moduli and densities: their products are finite.
constexpr double least_constant = 1e-30, largest_constant = 1e30;
constexpr const char* poisson_range = "-1 < poisson_ratio < 0.5";

[[noreturn]] void refuse(const std::string& what, const std::string& allowed) {
  throw std::invalid_argument(fmt::format("{} (allowed: {})", what, allowed));
}

void check_positive(const char* name, double value, const char* unit) {
  if (!(value >= least_constant && value <= largest_constant))
    refuse(fmt::format("{} = {} {}", name, value, unit),
           fmt::format("{} > 0, from {:g} to {:g} {}", name, least_constant, largest_constant, unit));
}

void check_poisson_ratio(double nu) {
  if (!(nu > -1 && nu < 0.5)) refuse(fmt::format("poisson_ratio = {}", nu), poisson_range);
}

/// "youngs_modulus = 10000 Pa", "poisson_ratio = 0.3", ... for the given moduli, each checked on its own.
std::vector<std::string> checked_names(const Moduli& given) {
  std::vector<std::string> names;
  auto positive = [&](const char* name, const std::optional<double>& value) {
    if (!value) return;
    check_positive(name, *value, "Pa");
    names.push_back(fmt::format("{} = {} Pa", name, *value));
  };
  positive("youngs_modulus", given.youngs_modulus);
  if (given.poisson_ratio) {
    check_poisson_ratio(*given.poisson_ratio);
    names.push_back(fmt::format("poisson_ratio = {}", *given.poisson_ratio));
  }
  positive("shear_modulus", given.shear_modulus);
  positive("bulk_modulus", given.bulk_modulus);
  if (given.lame_lambda) {
    if (!(std::abs(*given.lame_lambda) <= largest_constant))
      refuse(fmt::format("lame_lambda = {} Pa", *given.lame_lambda),
             fmt::format("up to {:g} Pa in size", largest_constant));
    names.push_back(fmt::format("lame_lambda = {} Pa", *given.lame_lambda));
  }
  return names;
}

/// E and nu from exactly two moduli; not finite or out of range where no solid has both.
IsotropicMaterial solve_for_E_nu(const Moduli& given, double density) {
  const auto& [E_, nu_, G_, K_, lambda_] = given;
  if (E_ && nu_) return {*E_, *nu_, density};
  if (E_ && G_) return {*E_, *E_ / (2 * *G_) - 1, density};
  if (E_ && K_) return {*E_, 0.5 - *E_ / (6 * *K_), density};
  if (E_ && lambda_) {
    const double E = *E_, lambda = *lambda_;
    const double R = std::sqrt(E * E + 9 * lambda * lambda + 2 * E * lambda);
    return {E, 2 * lambda / (E + lambda + R), density};
  }
  if (nu_ && G_) return {2 * *G_ * (1 + *nu_), *nu_, density};
  if (nu_ && K_) return {3 * *K_ * (1 - 2 * *nu_), *nu_, density};
  if (nu_ && lambda_) return {*lambda_ * (1 + *nu_) * (1 - 2 * *nu_) / *nu_, *nu_, density};
  if (G_ && K_) {
    const double G = *G_, K = *K_;
    return {9 * K * G / (3 * K + G), (3 * K - 2 * G) / (2 * (3 * K + G)), density};
  }
  if (G_ && lambda_) {
    const double G = *G_, lambda = *lambda_;
    return {G * (3 * lambda + 2 * G) / (lambda + G), lambda / (2 * (lambda + G)), density};
  }
  const double K = *K_, lambda = *lambda_;
  return {9 * K * (K - lambda) / (3 * K - lambda), lambda / (3 * K - lambda), density};
}

}  // namespace

double shear_modulus(const IsotropicMaterial& m) { return m.youngs_modulus / (2 * (1 + m.poisson_ratio)); }

double bulk_modulus(const IsotropicMaterial& m) { return m.youngs_modulus / (3 * (1 - 2 * m.poisson_ratio)); }

double lame_lambda(const IsotropicMaterial& m) {
  const double nu = m.poisson_ratio;
  return m.youngs_modulus * nu / ((1 + nu) * (1 - 2 * nu));
}

// G (4 nu - 1) / (1 - 2 nu) rather than lambda - G, which loses digits near nu = 1/4.
double kappa(const IsotropicMaterial& m) {
  const double nu = m.poisson_ratio;
  return shear_modulus(m) * (4 * nu - 1) / (1 - 2 * nu);
}

IsotropicMaterial material_from(const Moduli& given, double density) {
  const auto names = checked_names(given);
  if (names.size() != 2) {
    refuse(fmt::format("{} elastic moduli given{}{}", names.size(), names.empty() ? "" : ": ", fmt::join(names, ", ")),
           "exactly two of youngs_modulus, poisson_ratio, shear_modulus, bulk_modulus, lame_lambda");
  }
  const IsotropicMaterial m = solve_for_E_nu(given, density);
  const double nu = m.poisson_ratio;
  if (!(m.youngs_modulus > 0) || !std::isfinite(m.youngs_modulus) || !(nu > -1 && nu < 0.5)) {
    refuse(fmt::format("no elastic solid has {}: they give youngs_modulus = {} Pa, poisson_ratio = {}",
                       fmt::join(names, " and "), m.youngs_modulus, nu),
           fmt::format("youngs_modulus > 0, {}", poisson_range));
  }
  check_positive("density", density, "kg/m^3");
  return m;
}

void check(const IsotropicMaterial& m) {
  check_positive("youngs_modulus", m.youngs_modulus, "Pa");
  check_poisson_ratio(m.poisson_ratio);
  check_positive("density", m.density, "kg/m^3");
}

}  // namespace springproof
