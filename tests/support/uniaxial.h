// A bar with free sides, stretched uniformly: scalar equations for every finite-strain law.
#pragma once

#include <cmath>
#include <string>

#include "problem/material.h"

namespace springproof::test {

struct Uniaxial {
  double lateral;  ///< lateral stretch t
  double stress;   ///< axial force per rest area [Pa]
};

/// Root of f(t) = 0 near the linear solution, by secant steps.
template <class Function>
double lateral_root(const Function& f, double t) {
  double previous = t * (1 + 1e-3), before = f(previous);
  for (int i = 0; i < 100; ++i) {
    const double now = f(t);
    if (now == before || now == 0) break;
    const double next = t - now * (t - previous) / (now - before);
    previous = t;
    before = now;
    t = next;
  }
  return t;
}

/// Axial stretch l; W as in fem_reference/elements/laws.h.
inline Uniaxial uniaxial(const std::string& law, const IsotropicMaterial& m, double l) {
  const double E = m.youngs_modulus, nu = m.poisson_ratio, guess = std::pow(l, -nu);
  const double mu = shear_modulus(m), lambda = lame_lambda(m), K = bulk_modulus(m);
  if (law == "hencky") return {guess, E * std::log(l) / l};
  if (law == "log_cauchy") return {guess, E * std::log(l) * guess * guess};
  if (law == "st_venant_kirchhoff") {
    const double strain = (l * l - 1) / 2;
    return {std::sqrt(1 - 2 * nu * strain), l * E * strain};
  }
  if (law == "neo_hooke") {
    const auto side = [&](double t) { return mu * (t * t - 1) + lambda * std::log(l * t * t); };
    const double t = lateral_root(side, guess);
    return {t, (mu * (l * l - 1) + lambda * std::log(l * t * t)) / l};
  }
  // neo_hooke_isochoric, Kirchhoff stresses; what the sides do not carry is left out of the axial one
  const auto shear = [&](double t) { return mu * std::pow(l * t * t, -2. / 3) * (l * l - t * t); };
  const auto side = [&](double t) { return -shear(t) / 3 + K * (l * t * t - 1) * l * t * t; };
  const double t = lateral_root(side, guess);
  return {t, shear(t) / l};
}

}  // namespace springproof::test
