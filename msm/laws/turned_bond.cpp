#include "msm/laws/turned_bond.h"

#include "msm/laws/filled_volume.h"

namespace springproof {

bool turns(const InterfaceBond& bond) { return bond.stiffness != bond.stiffness(0, 0) * Eigen::Matrix3d::Identity(); }

TurnedBond::TurnedBond(const InterfaceBond& bond, const NodalVectors& X, const NodalVectors& x) {
  F.setZero();
  gap.setZero();
  for (int side = 0; side < 2; ++side) {
    const Hexahedron& corners = bond.corners[side];
    const double edge = (X.row(corners[1]) - X.row(corners[0])).norm();
    for (int n = 0; n < 8; ++n) {
      const int at = 8 * side + n;
      nodes[at] = corners[n];
      weights[at] = (side == 0 ? 1 : -1) * bond.weights[side][n];
      for (int axis = 0; axis < 3; ++axis) frame(axis, at) = corner_side(n, axis) / (8 * edge);
      const Vec3 position = x.row(corners[n]).transpose();
      F += position * frame.col(at).transpose();
      gap += weights[at] * position;
    }
  }
}

}  // namespace springproof
