// The isotropic linear-elastic material, given by any two of its moduli.
#pragma once

#include <algorithm>
#include <cmath>

#include <optional>

namespace springproof {

/// Isotropic elastic solid.  Valid range: -1 < nu < 1/2, E and rho from 1e-30 to 1e30.
struct IsotropicMaterial {
  double youngs_modulus;    ///< E [Pa]
  double poisson_ratio;     ///< nu [1]
  double density = 1000.0;  ///< rho [kg/m^3]
};

double shear_modulus(const IsotropicMaterial& m);  ///< G = E / (2 (1 + nu)) [Pa]
double bulk_modulus(const IsotropicMaterial& m);   ///< K = E / (3 (1 - 2 nu)) [Pa]
double lame_lambda(const IsotropicMaterial& m);    ///< lambda = E nu / ((1 + nu)(1 - 2 nu)) [Pa]

/// kappa = lambda - G [Pa], the modulus that springs, with their Cauchy relation lambda = G, cannot represent; zero at
/// nu = 1/4, negative below.  Golec et al. (2019), eqs. (5.4)-(5.5).
double kappa(const IsotropicMaterial& m);

/// Any subset of the moduli of an isotropic solid [Pa, nu in 1].
struct Moduli {
  std::optional<double> youngs_modulus;  ///< E [Pa]
  std::optional<double> poisson_ratio;   ///< nu [1]
  std::optional<double> shear_modulus;   ///< G [Pa]
  std::optional<double> bulk_modulus;    ///< K [Pa]
  std::optional<double> lame_lambda;     ///< lambda [Pa]
};

/// The material with exactly two given moduli.
/// @throws std::invalid_argument naming the modulus, its value and the allowed range, if not exactly two are
///   given, if one is out of range, or if they admit no solid with E > 0 and -1 < nu < 1/2.
/// Two solids can share (E, lambda); the one with the larger shear modulus is returned (the other has E or nu
/// out of range).
IsotropicMaterial material_from(const Moduli& given, double density = 1000.0);

/// @throws std::invalid_argument unless they are in the valid range of IsotropicMaterial.
void check(const IsotropicMaterial& m);

/// Whether two Poisson's ratios, either of which may come from a file, are equal to within 1e-9.
inline bool same_poisson_ratio(double a, double b) {
  return std::abs(a - b) < 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});  // a list of a region may be of moduli
}

}  // namespace springproof
