// Kelvin's solution: a point force in an infinite linear-elastic solid.
#pragma once

#include <Eigen/Core>

#include "problem/material.h"
#include "problem/vector.h"

namespace springproof {

/// The force, where it acts, and the solid.
struct KelvinSolution {
  Vec3 force = Vec3::Zero();     ///< [N]
  Vec3 at = Vec3::Zero();        ///< where it acts [m]
  IsotropicMaterial material{};  ///< of the infinite solid
};

/// With r = X - at, R = |r|: u = (1 + nu) / (8 pi E (1 - nu) R) ((3 - 4 nu) F + (F.r) r / R^2) [m].
/// @throws std::invalid_argument where R = 0, as do the functions below.
Vec3 kelvin_displacement(const KelvinSolution& solution, const Vec3& X);

/// Kot et al. (2014), eq. (23) [1].
Eigen::Matrix3d kelvin_strain(const KelvinSolution& solution, const Vec3& X);

/// sigma = -(3 (F.r) r r^T / R^3 + (1 - 2 nu) (F r^T + r F^T - (F.r) I) / R) / (8 pi (1 - nu) R^2) [Pa], tension
/// positive. Kot et al. (2014), eq. (24), DEVIATION: the minus, docs/papers.md #19.
Eigen::Matrix3d kelvin_stress(const KelvinSolution& solution, const Vec3& X);

}  // namespace springproof
