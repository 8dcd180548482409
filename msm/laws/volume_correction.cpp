#include "msm/laws/volume_correction.h"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace springproof {
namespace {

double sign(int corner, int axis) { return 2.0 * hexahedron_corners[corner][axis] - 1.0; }

Eigen::Matrix3d cross_matrix(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return m;
}

}  // namespace

VolumeDensity volume_density(VolumeEnergy form, double J) {
  if (form == VolumeEnergy::paper) return {0.5 * (J - 1) * (J - 1), J - 1, 1};
  const double root = std::cbrt(J);
  return {4.5 * (root - 1) * (root - 1), 3 * (root - 1) / (root * root), (2 / root - 1) / (J * root)};
}

MeanEdgeVolume mean_edge_volume(const Hexahedron& cell, const NodalVectors& x) {
  MeanEdgeVolume v;
  v.a.setZero();
  v.b.setZero();
  v.c.setZero();
  for (int n = 0; n < 8; ++n) {
    const Vec3 p = 0.25 * x.row(cell[n]).transpose();
    v.a += sign(n, 0) * p;
    v.b += sign(n, 1) * p;
    v.c += sign(n, 2) * p;
  }
  const Vec3 bc = v.b.cross(v.c), ca = v.c.cross(v.a), ab = v.a.cross(v.b);
  v.value = v.a.dot(bc);
  for (int n = 0; n < 8; ++n)
    v.gradient.row(n) = 0.25 * (sign(n, 0) * bc + sign(n, 1) * ca + sign(n, 2) * ab).transpose();
  return v;
}

double VolumeCorrection::energy(const Network& network, const NodalVectors& x) const {
  const double V = network.cell_volume();
  double sum = 0;
  for (const Hexahedron& cell : network.cells) {
    const double J = mean_edge_volume(cell, x).value / V;
    if (J <= 0 && form == VolumeEnergy::bounded) return std::numeric_limits<double>::infinity();
    sum += V * kappa * volume_density(form, J).value;
  }
  return sum;
}

void VolumeCorrection::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  const double V = network.cell_volume();
  for (const Hexahedron& cell : network.cells) {
    const MeanEdgeVolume v = mean_edge_volume(cell, x);
    const double pressure = kappa * volume_density(form, v.value / V).slope;
    for (int n = 0; n < 8; ++n) f.row(cell[n]) -= pressure * v.gradient.row(n);
  }
}

void VolumeCorrection::add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const {
  const double V = network.cell_volume();
  for (const Hexahedron& cell : network.cells) {
    const MeanEdgeVolume v = mean_edge_volume(cell, x);
    const VolumeDensity d = volume_density(form, v.value / V);
    for (int m = 0; m < 8; ++m)
      for (int n = 0; n < 8; ++n)
        K.add(cell[m], cell[n], kappa * d.curvature / V * v.gradient.row(m).transpose() * v.gradient.row(n));
    add_volume_curvature(cell, v, kappa * d.slope, K);
  }
}

void add_volume_curvature(const Hexahedron& cell, const MeanEdgeVolume& v, double pressure, BlockMatrix& K) {
  const Eigen::Matrix3d A = cross_matrix(v.a), B = cross_matrix(v.b), C = cross_matrix(v.c);
  for (int m = 0; m < 8; ++m)
    for (int n = 0; n < 8; ++n) {
      // From the product rule on b x c, c x a, a x b.
      const Eigen::Matrix3d curvature = (1.0 / 16) * (sign(m, 0) * (sign(n, 2) * B - sign(n, 1) * C) +
                                                      sign(m, 1) * (sign(n, 0) * C - sign(n, 2) * A) +
                                                      sign(m, 2) * (sign(n, 1) * A - sign(n, 0) * B));
      K.add(cell[m], cell[n], pressure * curvature);
    }
}

}  // namespace springproof
