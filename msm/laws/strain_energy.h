// Strain energy density of a cell of averaged springs as a function of its deformation gradient F, and its derivatives.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "msm/laws/volume_correction.h"

namespace springproof {

/// The material law that the springs of a cell follow at large strain.  All have the moduli G and lambda at small
/// strain, and all but neo_hooke separate the change of volume from the distortion: springs and areas act on lengths
/// divided by J^(1/3), so that the volume term carries the whole bulk modulus K > 0.
enum class StrainCurve {
  hencky,               ///< length-area-volume: G f(y) of squared lengths of edges and faces; K/2 ln^2 J
  neo_hooke,            ///< edges as springs of rest length 0: G/2 (tr C - 3 - 2 ln J) + lambda/2 ln^2 J
  neo_hooke_isochoric,  ///< the same at constant volume: G/2 (J^(-2/3) tr C - 3) + K/2 (J - 1)^2
  springs_hencky,       ///< thirteen springs whose stiffness falls with their stretch as Hencky's law wants it
  springs_neo_hooke,    ///< thirteen springs tuned to neo_hooke_isochoric
};
constexpr std::array<const char*, 5> names_of(StrainCurve) {
  return {"hencky", "neo_hooke", "neo_hooke_isochoric", "springs_hencky", "springs_neo_hooke"};
}

/// A direction of springs, and its share in sum k L^2.
struct SpringDirection {
  Eigen::Vector3d n;  ///< unit vector
  double weight;      ///< they sum to 1
};

/// The edges, face diagonals and cube diagonals of a cell with the weights of the quadrature over directions that is
/// exact to seventh degree (Lebedev's 26 points): A = 16/9.
std::span<const SpringDirection> spring_directions();

/// Of two entries of F each.
using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// W [Pa], P = dW/dF [Pa] and d2W/dF2 [Pa], whose index of F(i, j) is i + 3 j.
struct StrainEnergy {
  double value = 0;                                  ///< W [Pa]
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();  ///< P [Pa]
  Matrix9 tangent = Matrix9::Zero();                 ///< d2W/dF2 [Pa]
};

/// What to compute of a strain energy: all up to this.
enum class Derivative { none, first, second };

/// U(J) per unit of bulk modulus, and its derivatives.
VolumeDensity volume_term(StrainCurve curve, double J);

/// W of springs alone (lambda = G, nu = 1/4), for det F > 0.  That of a material is W + (lambda - G) U(J).
StrainEnergy springs_energy(StrainCurve curve, double shear_modulus, const Eigen::Matrix3d& F, Derivative up_to);

/// Adds factor * U(det F).
void add_volume_term(StrainCurve curve, double factor, const Eigen::Matrix3d& F, Derivative up_to, StrainEnergy& W);

}  // namespace springproof
