// Isotropic laws at finite strain, written in the principal values of the right Cauchy-Green tensor C = F^T
// F.
//
// All share one form: the second Piola-Kirchhoff stress S = S_shear(C) + p Q(C), with a pressure p that
// depends on a dilatation g alone.  So the elements can average g, or make p an unknown, independently of the law; the
// quantity averaged is the volume change itself (St. Venant-Kirchhoff: tr E).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace springproof::fem {

/// In the order of laws_of_large_strain, which names them (problem/large_strain.h).
enum class Law {
  hencky,               ///< Kirchhoff stress = 2 mu ln V + lambda ln J I; hyperelastic
  log_cauchy,           ///< Cauchy stress = 2 mu ln V + lambda ln J I (as LS-Dyna's hypoelastic solid); not
                        ///< hyperelastic
  neo_hooke,            ///< W = mu/2 (tr C - 3 - 2 ln J) + lambda/2 ln^2 J
  neo_hooke_isochoric,  ///< W = mu/2 (J^(-2/3) tr C - 3) + K/2 (J - 1)^2, K = lambda + 2 mu/3, as Abaqus and
                        ///< CalculiX
  st_venant_kirchhoff   ///< S = 2 mu E + lambda tr E I, E = (C - I)/2
};

/// Nothing if there is no such law.
std::optional<Law> law_named(const std::string& name);

/// "hencky, log_cauchy, ..." for messages.
std::string law_names();

using Voigt = Eigen::Matrix<double, 6, 1>;  ///< xx yy zz xy yz xz

/// The symmetric tensor of these components.
inline Eigen::Matrix3d tensor(const Voigt& s) {
  Eigen::Matrix3d t;
  t << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return t;
}

struct LawResponse {
  Voigt S;                        ///< second Piola-Kirchhoff stress [Pa]
  Voigt Q;                        ///< dS / dp
  Voigt G;                        ///< dg / dC, each shear pair counted once
  Eigen::Matrix<double, 6, 6> D;  ///< dS / dC at fixed p [Pa], for increments (dCxx dCyy dCzz 2dCxy 2dCyz 2dCxz)
};

/// Response at deformation gradient F (det F > 0) and pressure p [Pa]; mu is the shear modulus [Pa].
LawResponse respond(Law law, double mu, double p, const Eigen::Matrix3d& F);

/// Its stress alone [Pa], at C = F^T F.
Voigt stress(Law law, double mu, double p, const Eigen::Matrix3d& C);

/// The dilatation g = J - 1, or tr E for St. Venant-Kirchhoff.
double dilatation(Law law, const Eigen::Matrix3d& F);

struct ValueAndSlope {
  double value, slope;
};

/// p(g) [Pa]: lambda ln J / J, lambda ln J (log_cauchy), lambda g (neo_hooke_isochoric, the rest of K being
/// in S_shear; St. Venant-Kirchhoff).
ValueAndSlope pressure(Law law, double lambda, double g);

/// Its inverse g(p).  Where hencky and neo_hooke have none (lambda / e < p, J beyond e) the largest attainable g.
ValueAndSlope dilatation_at_pressure(Law law, double lambda, double p);

/// Energy per rest volume of S_shear [Pa], det F > 0.  Not of log_cauchy, which has none: NaN.
double shear_energy(Law law, double mu, const Eigen::Matrix3d& F);

/// That of the pressure, whose derivative is p(g) [Pa].  Not of log_cauchy: NaN.
double dilatation_energy(Law law, double lambda, double g);

}  // namespace springproof::fem
