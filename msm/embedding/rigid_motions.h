// Rigid motions of a body's nodes, and those of them that its supports leave.
#pragma once

#include <vector>

#include "problem/vector.h"

namespace springproof {

/// Values of the six rigid motions at an unknown 3 * node + axis: translations, then rotations about the centre,
/// divided by the size.
struct RigidMotions {
  using Values = Eigen::Matrix<double, 6, 1>;

  const NodalVectors& X;
  Vec3 middle = X.colwise().mean().transpose();
  double size = (X.colwise().maxCoeff() - X.colwise().minCoeff()).norm();

  Values at(int unknown) const;
};

/// Combinations of the six rigid motions that are zero on the fixed unknowns: one column each, 6 x 0 to 6.
Eigen::Matrix<double, 6, Eigen::Dynamic> free_motions(const std::vector<char>& fixed, const RigidMotions& rigid);

}  // namespace springproof
