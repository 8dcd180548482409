#include "comparisons/judge/rigid_motion.h"

#include <Eigen/Dense>
#include <cmath>

#include "comparisons/judge/reference_value.h"

namespace springproof {
namespace {

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

/// R - 1 of the rotation nearest to r + u = R r (Kabsch 1976).
Eigen::Matrix3d nearest_turn(const NodalVectors& r, const NodalVectors& u, const Eigen::VectorXd& weights) {
  const Eigen::Matrix3d moments = (r + u).transpose() * weights.asDiagonal() * r;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs = Vec3::Ones();
  signs[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose() - Eigen::Matrix3d::Identity();
}

double largest_at_node(const NodalVectors& u) { return u.rows() > 0 ? u.rowwise().norm().maxCoeff() : 0; }

}  // namespace

NodalVectors less_rigid_motion(const NodalVectors& X, const NodalVectors& u, const Eigen::VectorXd& weights,
                               Kinematics kinematics) {
  const NodalVectors r = X.rowwise() - weighted_mean(X, weights), v = u.rowwise() - weighted_mean(u, weights);
  const Eigen::Matrix3d turn =
      kinematics == Kinematics::linear ? nearest_spin(r, v, weights) : nearest_turn(r, v, weights);
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
