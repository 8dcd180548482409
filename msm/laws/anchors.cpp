#include "msm/laws/anchors.h"

#include "msm/cells/filled_volume.h"

namespace springproof {
namespace {

Vec3 stretch(const Anchor& a, const NodalVectors& x) {
  Vec3 d = -x.row(a.node).transpose();
  for (int n = 0; n < 8; ++n) d += a.weights[n] * x.row(a.corners[n]).transpose();
  return d;
}

/// K += the tangent of a bond that turns: of w = K v, and of how v depends on the positions.
void add_tangent_of(const TurnedBond& at, const Eigen::Matrix3d& stiffness, BlockMatrix& K) {
  const Vec3 w = stiffness * at.v();
  const Eigen::Matrix<double, 1, 16> along = w.transpose() * at.frame;
  std::array<Eigen::Matrix3d, 16> slope;  // of v
  for (int n = 0; n < 16; ++n) slope[n] = at.weights[n] * at.F.transpose() + at.frame.col(n) * at.gap.transpose();
  for (int m = 0; m < 16; ++m)
    for (int n = 0; n < 16; ++n) {
      const double turned = at.weights[m] * along[n] + at.weights[n] * along[m];
      K.add(at.nodes[m], at.nodes[n],
            slope[m].transpose() * stiffness * slope[n] + turned * Eigen::Matrix3d::Identity());
    }
}

}  // namespace

double Anchors::energy(const Network& network, const NodalVectors& x) const {
  double sum = 0;
  for (const Anchor& a : network.anchors) {
    const Vec3 d = stretch(a, x);
    sum += d.dot(a.stiffness * d) / 2;
  }
  for (const InterfaceBond& b : network.bonds) {
    const Vec3 v = turns(b) ? TurnedBond(b, network.X, x).v() : gap(b, x);
    sum += v.dot(b.stiffness * v) / 2;
  }
  return sum;
}

void Anchors::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  for (const Anchor& a : network.anchors) {
    const Vec3 force = a.stiffness * stretch(a, x);
    f.row(a.node) += force.transpose();
    for (int n = 0; n < 8; ++n) f.row(a.corners[n]) -= a.weights[n] * force.transpose();
  }
  for (const InterfaceBond& b : network.bonds) {
    if (turns(b)) {
      const TurnedBond at(b, network.X, x);
      at.for_each_gradient(b.stiffness * at.v(), [&](int node, const Vec3& g) { f.row(node) -= g.transpose(); });
      continue;
    }
    const Vec3 force = b.stiffness * gap(b, x);
    for_each_corner(b, [&](int node, double weight) { f.row(node) -= weight * force.transpose(); });
  }
}

void Anchors::add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const {
  for (const Anchor& a : network.anchors) {
    K.add(a.node, a.node, a.stiffness);
    for (int m = 0; m < 8; ++m) {
      K.add(a.node, a.corners[m], -a.weights[m] * a.stiffness);
      K.add(a.corners[m], a.node, -a.weights[m] * a.stiffness);
      for (int n = 0; n < 8; ++n) K.add(a.corners[m], a.corners[n], a.weights[m] * a.weights[n] * a.stiffness);
    }
  }
  for (const InterfaceBond& b : network.bonds)
    if (turns(b))
      add_tangent_of({b, network.X, x}, b.stiffness, K);
    else
      for_each_corner(
          b, [&](int m, double v) { for_each_corner(b, [&](int n, double w) { K.add(m, n, v * w * b.stiffness); }); });
}

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
