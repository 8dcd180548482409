#include "msm/laws/macro_points.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "meshes/voxels/triquadratic.h"

namespace springproof {
namespace {

/// Least standard deviation of the linear modes of the volume, in edges of a cube: sheets have some thickness.
constexpr double least_deviation = 1e-3;

std::vector<MacroPoint> gauss_points() {
  const double r = std::sqrt(0.6), at[3] = {-r, 0, r}, weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  std::vector<MacroPoint> points;
  for (int q = 0; q < 27; ++q) {
    const int i = q % 3, j = q / 3 % 3, k = q / 9;
    const Vec3 x(at[i], at[j], at[k]);
    const Eigen::Vector4d modes(1, std::sqrt(3) * x[0], std::sqrt(3) * x[1], std::sqrt(3) * x[2]);
    points.push_back({x, weight[i] * weight[j] * weight[k], triquadratic_gradients(x), modes});
  }
  return points;
}

/// Columns: principal standard deviations of the filled part of a cube, in its edges.
Eigen::Matrix3d principal_deviations(const FilledPart& part) {
  const Eigen::Matrix3d covariance = second_moments(part) - part.mean * part.mean.transpose();
  if (covariance.isDiagonal(1e-9)) return part.variance.cwiseSqrt().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(covariance);
  return principal.eigenvectors() * principal.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

/// Orthonormalises the modes 1, x, y, z in the mean over the points.
void set_modes(std::vector<MacroPoint>& points) {
  Vec3 mean = Vec3::Zero();
  for (const MacroPoint& p : points) mean += p.share * p.at;
  Eigen::Matrix3d covariance = least_deviation * least_deviation * Eigen::Matrix3d::Identity();
  for (const MacroPoint& p : points) covariance += p.share * (p.at - mean) * (p.at - mean).transpose();
  const Eigen::LLT<Eigen::Matrix3d> factor(covariance);
  for (MacroPoint& p : points) {
    p.modes[0] = 1;
    p.modes.tail<3>() = factor.matrixL().solve(p.at - mean);
  }
}

}  // namespace

Eigen::Matrix<double, 3, 27> at_nodes(const MacroCell& cell, const NodalVectors& values) {
  Eigen::Matrix<double, 3, 27> at;
  for (int n = 0; n < 27; ++n) at.col(n) = values.row(cell[n]).transpose();
  return at;
}

bool is_full(const Network& network, std::size_t cell) {
  return network.filled.empty() || std::all_of(network.filled.begin() + static_cast<long>(8 * cell),
                                               network.filled.begin() + static_cast<long>(8 * cell + 8),
                                               [](const FilledPart& part) { return part.fraction == 1; });
}

MacroPoints macro_points(const Network& network, std::size_t cell) {
  static const std::vector<MacroPoint> of_full = gauss_points();
  MacroPoints out;
  if (is_full(network, cell)) {
    out.volume = 8 * network.cell_volume();
    out.points = of_full;
    return out;
  }
  double filled = 0;
  for (int cube = 0; cube < 8; ++cube) {
    const FilledPart& part = network.filled[8 * cell + cube];
    if (part.fraction == 0) continue;
    filled += part.fraction;
    const Eigen::Matrix3d deviation = principal_deviations(part);
    for (int s = 0; s < 8; ++s) {
      const Vec3 sign(s & 1 ? 1 : -1, s & 2 ? 1 : -1, s & 4 ? 1 : -1),
          at = middle_of_cube(cube) + part.mean + deviation * sign;
      out.own.push_back({at, part.fraction / 8, triquadratic_gradients(at), Eigen::Vector4d::Zero()});
    }
  }
  for (MacroPoint& p : out.own) p.share /= filled;
  out.volume = filled * network.cell_volume();
  set_modes(out.own);
  out.points = out.own;
  return out;
}

}  // namespace springproof
