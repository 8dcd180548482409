#include "comparisons/judge/deformation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "comparisons/judge/reference_value.h"

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
  std::ranges::sort(values, [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
  double whole = 0, sum = 0;
  for (const Weighted& v : values) whole += v.weight;
  for (const Weighted& v : values)
    if ((sum += v.weight) >= share_below * whole) return v.value;
  return 0;
}

Eigen::Matrix3d cross_matrix(const Vec3& r) {
  Eigen::Matrix3d m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

Eigen::RowVector3d weighted_mean(const NodalVectors& v, const Eigen::VectorXd& weights) {
  return weights.transpose() * v / weights.sum();
}

/// Small rotation w nearest to u = w x r; of points on a line none about it.
Eigen::Matrix3d nearest_spin(const NodalVectors& r, const NodalVectors& u, const Eigen::VectorXd& weights) {
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  Vec3 momentum = Vec3::Zero();
  for (Eigen::Index n = 0; n < r.rows(); ++n) {
    const Eigen::Matrix3d arm = cross_matrix(r.row(n).transpose());
    inertia -= weights[n] * arm * arm;
    momentum += weights[n] * arm * u.row(n).transpose();
  }
  return cross_matrix(inertia.completeOrthogonalDecomposition().solve(momentum));
}

double largest_at_node(const NodalVectors& u) { return u.rows() > 0 ? u.rowwise().norm().maxCoeff() : 0; }

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

Eigen::Matrix3d nearest_rotation(const NodalVectors& from, const NodalVectors& to, const Eigen::VectorXd& weights) {
  const Eigen::Matrix3d moments = to.transpose() * weights.asDiagonal() * from;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Vec3(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

NodalVectors less_rigid_motion(const NodalVectors& X, const NodalVectors& u, const Eigen::VectorXd& weights,
                               Kinematics kinematics) {
  const NodalVectors r = X.rowwise() - weighted_mean(X, weights), v = u.rowwise() - weighted_mean(u, weights);
  const Eigen::Matrix3d turn = kinematics == Kinematics::linear
                                   ? nearest_spin(r, v, weights)
                                   : Eigen::Matrix3d(nearest_rotation(r, r + v, weights) - Eigen::Matrix3d::Identity());
  return v - r * turn.transpose();
}

DisplacementScale displacement_scale(const Mesh& mesh, const NodalVectors& u, bool moved, Kinematics kinematics) {
  const Eigen::VectorXd weights = nodal_volumes(mesh);
  const DisplacementScale whole{weighted_norm(u, weights), largest_at_node(u)};
  if (!moved || !(whole.mean > 0)) return whole;
  const NodalVectors strained = less_rigid_motion(mesh.nodes, u, weights, kinematics);
  const double left = weighted_norm(strained, weights), share = left / whole.mean;
  if (share >= carried_share || share <= solver_noise) return whole;
  return {left, largest_at_node(strained), share};
}

}  // namespace springproof
