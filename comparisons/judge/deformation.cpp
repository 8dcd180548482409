#include "comparisons/judge/deformation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace springproof {
namespace {

constexpr double share_below = 0.99;

using Corners = Eigen::Matrix<double, 8, 3>;

/// Gradients of the trilinear shape functions with respect to the unit cube's coordinates.
Corners shape_gradients(const Vec3& unit) {
  Corners gradients;
  for (int n = 0; n < 8; ++n)
    for (int d = 0; d < 3; ++d) {
      double product = hexahedron_corners[n][d] ? 1 : -1;
      for (int e = 0; e < 3; ++e)
        if (e != d) product *= hexahedron_corners[n][e] ? unit[e] : 1 - unit[e];
      gradients(n, d) = product;
    }
  return gradients;
}

DeformationSize size_of(const Eigen::Matrix3d& gradient, Kinematics kinematics) {
  if (kinematics == Kinematics::linear) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> strain((gradient + gradient.transpose()) / 2,
                                                                Eigen::EigenvaluesOnly);
    const Eigen::Matrix3d spin = (gradient - gradient.transpose()) / 2;
    return {strain.eigenvalues().cwiseAbs().maxCoeff(), spin.norm() / std::sqrt(2.0)};
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(Eigen::Matrix3d::Identity() + gradient,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
  const Vec3 twice_axis(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return {(svd.singularValues().array() - 1).abs().maxCoeff(), std::atan2(twice_axis.norm(), R.trace() - 1)};
}

struct Weighted {
  double value, weight;
};

double percentile(std::vector<Weighted> values) {
  std::sort(values.begin(), values.end(), [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
  double whole = 0, sum = 0;
  for (const Weighted& v : values) whole += v.weight;
  for (const Weighted& v : values)
    if ((sum += v.weight) >= share_below * whole) return v.value;
  return 0;
}

}  // namespace

DeformationSize deformation_size(const Mesh& mesh, const NodalVectors& displacement, Kinematics kinematics) {
  const double low = 0.5 - std::sqrt(1 / 12.0), high = 1 - low;
  std::vector<Corners> at_points;
  for (const auto& corner : hexahedron_corners)
    at_points.push_back(shape_gradients(Vec3(corner[0] ? high : low, corner[1] ? high : low, corner[2] ? high : low)));
  std::vector<Weighted> strains, rotations;
  for (const Hexahedron& cell : mesh.hexahedra) {
    Corners X, u;
    for (int n = 0; n < 8; ++n) {
      X.row(n) = mesh.nodes.row(cell[n]);
      u.row(n) = displacement.row(cell[n]);
    }
    for (const Corners& gradients : at_points) {
      const Eigen::Matrix3d jacobian = X.transpose() * gradients;
      const DeformationSize here = size_of(u.transpose() * gradients * jacobian.inverse(), kinematics);
      const double weight = std::abs(jacobian.determinant());
      strains.push_back({here.principal_strain, weight});
      rotations.push_back({here.rotation, weight});
    }
  }
  return {percentile(std::move(strains)), percentile(std::move(rotations))};
}

}  // namespace springproof
