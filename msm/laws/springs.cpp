#include "msm/laws/springs.h"

namespace springproof {

double Springs::energy(const Network& network, const NodalVectors& x) const {
  double sum = 0;
  for (const Spring& s : network.springs) {
    const double stretch = (x.row(s.j) - x.row(s.i)).norm() - s.rest_length;
    sum += 0.5 * s.stiffness * stretch * stretch;
  }
  return sum;
}

void Springs::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  for (const Spring& s : network.springs) {
    const Eigen::RowVector3d d = x.row(s.j) - x.row(s.i);
    const double length = d.norm();
    const Eigen::RowVector3d pull = (s.stiffness * (length - s.rest_length) / length) * d;
    f.row(s.i) += pull;
    f.row(s.j) -= pull;
  }
}

void Springs::add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const {
  for (const Spring& s : network.springs) {
    const Vec3 d = (x.row(s.j) - x.row(s.i)).transpose();
    const double length = d.norm();
    const Vec3 n = d / length;
    const double geometric = s.stiffness * (1 - s.rest_length / length);
    const Eigen::Matrix3d block =
        (s.stiffness - geometric) * n * n.transpose() + geometric * Eigen::Matrix3d::Identity();
    K.add(s.i, s.i, block);
    K.add(s.j, s.j, block);
    K.add(s.i, s.j, -block);
    K.add(s.j, s.i, -block);
  }
}

}  // namespace springproof
