#include "problem/kelvin.h"

#include <numbers>
#include <stdexcept>

namespace springproof {
namespace {

using std::numbers::pi;

/// Vector from the force to X.
struct Arm {
  Vec3 n;    ///< direction
  double R;  ///< length [m]
};

Arm arm_of(const KelvinSolution& solution, const Vec3& X) {
  const Vec3 r = X - solution.at;
  const double R = r.norm();
  if (!(R > 0)) throw std::invalid_argument("kelvin: the solution is infinite where the point force acts");
  return {r / R, R};
}

Eigen::Matrix3d symmetric(const Vec3& a, const Vec3& b) { return a * b.transpose() + b * a.transpose(); }

}  // namespace

Vec3 kelvin_displacement(const KelvinSolution& solution, const Vec3& X) {
  const auto [n, R] = arm_of(solution, X);
  const double E = solution.material.youngs_modulus, nu = solution.material.poisson_ratio;
  return (1 + nu) / (8 * pi * E * (1 - nu) * R) * ((3 - 4 * nu) * solution.force + solution.force.dot(n) * n);
}

Eigen::Matrix3d kelvin_strain(const KelvinSolution& solution, const Vec3& X) {
  const auto [n, R] = arm_of(solution, X);
  const double E = solution.material.youngs_modulus, nu = solution.material.poisson_ratio,
               along = solution.force.dot(n);
  return -(1 + nu) / (8 * pi * E * (1 - nu) * R * R) *
         (3 * along * n * n.transpose() - along * Eigen::Matrix3d::Identity() +
          (1 - 2 * nu) * symmetric(solution.force, n));
}

Eigen::Matrix3d kelvin_stress(const KelvinSolution& solution, const Vec3& X) {
  const auto [n, R] = arm_of(solution, X);
  const double nu = solution.material.poisson_ratio, along = solution.force.dot(n);
  return -1 / (8 * pi * (1 - nu) * R * R) *
         (3 * along * n * n.transpose() +
          (1 - 2 * nu) * (symmetric(solution.force, n) - along * Eigen::Matrix3d::Identity()));
}

}  // namespace springproof
