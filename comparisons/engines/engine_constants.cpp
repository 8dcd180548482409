#include "comparisons/engines/engine_constants.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "comparisons/engines/five_tetrahedra.h"
#include "msm/algebra/dense.h"

namespace springproof {

BulletNeoHooke bullet_neo_hooke(const IsotropicMaterial& m) {
  const double G = shear_modulus(m);
  return {4.0 / 3 * G, lame_lambda(m) + 5.0 / 6 * G};
}

double volume_compliance(double tetrahedron_volume, double bulk) { return 36 * tetrahedron_volume / bulk; }

double implicit_euler_damping(double frequency, double time_step) { return std::numbers::pi * frequency * time_step; }

double least_single_precision_step(double reach, double acceleration) {
  return std::sqrt(std::ldexp(reach, -23) / acceleration);
}

double largest_sweep_step(double safe_time_step) { return 0.25 * safe_time_step; }

double safe_time_step_of_tetrahedra(const IsotropicMaterial& m, double edge) {
  const double G = shear_modulus(m), lambda = lame_lambda(m);
  NodalVectors X(8, 3);
  Hexahedron cell;
  for (int c = 0; c < 8; ++c) {
    cell[c] = c;
    for (int d = 0; d < 3; ++d) X(c, d) = hexahedron_corners[c][d];
  }
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(24, 24);  // of a cube of edge 1 m
  for (const Tetrahedron& t : five_tetrahedra(X, {cell}, 1)) {
    Eigen::Matrix4d corners;
    for (int a = 0; a < 4; ++a) corners.row(a) << 1, X.row(t[a]);
    const double volume = corners.determinant() / 6;
    const Eigen::Matrix<double, 3, 4> gradient = corners.inverse().bottomRows(3);  // of the shape functions
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        const Vec3 g = gradient.col(a), h = gradient.col(b);
        K.block<3, 3>(3 * t[a], 3 * t[b]) +=
            volume * (lambda * g * h.transpose() + G * h * g.transpose() + G * g.dot(h) * Eigen::Matrix3d::Identity());
      }
  }
  const double stiffest = symmetric_eigenvalues(K)[23] / (m.density / 8);
  return 2 * edge / std::sqrt(stiffest);
}

}  // namespace springproof
