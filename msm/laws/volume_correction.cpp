#include "msm/laws/volume_correction.h"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

#include "msm/cells/filled_volume.h"

namespace springproof {

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
    v.a += corner_side(n, 0) * p;
    v.b += corner_side(n, 1) * p;
    v.c += corner_side(n, 2) * p;
  }
  const Vec3 bc = v.b.cross(v.c), ca = v.c.cross(v.a), ab = v.a.cross(v.b);
  v.value = v.a.dot(bc);
  for (int n = 0; n < 8; ++n)
    v.gradient.row(n) = 0.25 * (corner_side(n, 0) * bc + corner_side(n, 1) * ca + corner_side(n, 2) * ab).transpose();
  return v;
}

double VolumeCorrection::energy(const Network& network, const NodalVectors& x) const {
  const double V = network.cells.volume();
  double sum = 0;
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const VolumeCorrection& own = in(network.cells.material(c));
    const double J = mean_edge_volume(network.cells.corners[c], x).value / V;
    if (J <= 0 && own.form == VolumeEnergy::bounded) return std::numeric_limits<double>::infinity();
    sum += V * own.kappa * volume_density(own.form, J).value;
  }
  return sum;
}

void VolumeCorrection::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  const double V = network.cells.volume();
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const Hexahedron& cell = network.cells.corners[c];
    const VolumeCorrection& own = in(network.cells.material(c));
    const MeanEdgeVolume v = mean_edge_volume(cell, x);
    const double pressure = own.kappa * volume_density(own.form, v.value / V).slope;
    for (int n = 0; n < 8; ++n) f.row(cell[n]) -= pressure * v.gradient.row(n);
  }
}

void VolumeCorrection::add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const {
  const double V = network.cells.volume();
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const Hexahedron& cell = network.cells.corners[c];
    const VolumeCorrection& own = in(network.cells.material(c));
    const MeanEdgeVolume v = mean_edge_volume(cell, x);
    const VolumeDensity d = volume_density(own.form, v.value / V);
    for (int m = 0; m < 8; ++m)
      for (int n = 0; n < 8; ++n)
        K.add(cell[m], cell[n], own.kappa * d.curvature / V * v.gradient.row(m).transpose() * v.gradient.row(n));
    add_volume_curvature(cell, v, own.kappa * d.slope, K);
  }
}

void add_volume_curvature(const Hexahedron& cell, const MeanEdgeVolume& v, double pressure, BlockMatrix& K) {
  const Eigen::Matrix3d A = cross_matrix(v.a), B = cross_matrix(v.b), C = cross_matrix(v.c);
  for (int m = 0; m < 8; ++m)
    for (int n = 0; n < 8; ++n) {
      // From the product rule on b x c, c x a, a x b.
      const Eigen::Matrix3d curvature =
          (1.0 / 16) * (corner_side(m, 0) * (corner_side(n, 2) * B - corner_side(n, 1) * C) +
                        corner_side(m, 1) * (corner_side(n, 0) * C - corner_side(n, 2) * A) +
                        corner_side(m, 2) * (corner_side(n, 1) * A - corner_side(n, 0) * B));
      K.add(cell[m], cell[n], pressure * curvature);
    }
}

}  // namespace springproof
