// The conditions of the patch test at the nodes of a network (patch_fit.h), and the fields that they cannot see.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "msm/topology/network.h"

namespace springproof {

/// Conditions of a node: of a symmetric tensor of third order the components xxx yyy zzz xxy xxz yyx yyz zzx zzy xyz,
/// each times the root of the number of its permutations, so that scalar products are those of tensors.
inline constexpr int patch_moments = 10;
using PatchMoments = Eigen::Matrix<double, patch_moments, 1>;

/// The symmetric part of a (x) b (x) c.
PatchMoments symmetric_product(const Vec3& a, const Vec3& b, const Vec3& c);

/// d_ij A_k + d_jk A_i + d_ki A_j, d Kronecker's symbol.
PatchMoments patch_traction(const Vec3& A);

/// A spring between the conditions of two nodes: with the constant t it contributes t column to those of i, minus as
/// much to those of j.
struct PatchColumn {
  int i, j;
  PatchMoments column;
};

/// Coarse correction for B W B^T + D, B the matrix of the columns, W and D diagonal, D equal within a node.
///
/// The fields y that B^T does not see, column . (y_i - y_j) = 0 for every spring, are the Killing tensors of third
/// order: symmetric products of three of the six velocities of rigid motions, each of which is the same at both ends
/// along the spring.  There are 50, polynomials of the position up to the third degree (Thompson, J. Math. Phys. 27,
/// 1986, 2693).  Smooth fields are nearly of this kind in any part of the body, so without them conjugate gradients
/// take ten times as many iterations.  The coarse space is spanned by them in each of the boxes into which the body is
/// divided.
class KillingSpace {
 public:
  /// @param X positions of the nodes [m], n x 3
  /// @param spacing of the nodes [m]
  KillingSpace(const NodalVectors& X, double spacing);
  /// Factors the operator in the space.
  void factor(const std::vector<PatchColumn>& columns, const Eigen::VectorXd& W, const Eigen::VectorXd& D);
  /// z += the correction for the residual r, in single precision.
  void add(const Eigen::VectorXf& r, Eigen::VectorXf& z) const;

 private:
  int first(int node) const { return first_[box_[node]]; }

  std::vector<int> box_;                ///< per node
  std::vector<int> first_;              ///< per box: the first of its unknowns
  std::vector<Eigen::MatrixXf> basis_;  ///< per node: conditions x unknowns of its box
  int unknowns_ = 0;
  Eigen::MatrixXf factor_;  ///< Cholesky's, its lower triangle
};

}  // namespace springproof
