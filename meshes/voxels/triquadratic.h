// Interpolation in a cell of 27 points.
#pragma once

#include <Eigen/Core>
#include <array>

#include "problem/vector.h"

namespace springproof {

/// Quadratic functions of the points -1, 0 and 1.
inline std::array<double, 3> quadratic_weights(double t) { return {t * (t - 1) / 2, 1 - t * t, t * (t + 1) / 2}; }

/// Their derivatives.
inline std::array<double, 3> quadratic_slopes(double t) { return {t - 0.5, -2 * t, t + 0.5}; }

/// Weights of the points of the cell [-1, 1]^3, x + 3 y + 9 z at (x, y, z) - 1.
inline std::array<double, 27> triquadratic_weights(const Vec3& at) {
  const auto x = quadratic_weights(at[0]), y = quadratic_weights(at[1]), z = quadratic_weights(at[2]);
  std::array<double, 27> all;
  for (int n = 0; n < 27; ++n) all[n] = x[n % 3] * y[n / 3 % 3] * z[n / 9];
  return all;
}

/// Their gradients, a column per point.
inline Eigen::Matrix<double, 3, 27> triquadratic_gradients(const Vec3& at) {
  std::array<std::array<double, 3>, 3> value, slope;
  for (int d = 0; d < 3; ++d) {
    value[d] = quadratic_weights(at[d]);
    slope[d] = quadratic_slopes(at[d]);
  }
  Eigen::Matrix<double, 3, 27> all;
  for (int n = 0; n < 27; ++n) {
    const int a = n % 3, b = n / 3 % 3, c = n / 9;
    all.col(n) << slope[0][a] * value[1][b] * value[2][c], value[0][a] * slope[1][b] * value[2][c],
        value[0][a] * value[1][b] * slope[2][c];
  }
  return all;
}

}  // namespace springproof
