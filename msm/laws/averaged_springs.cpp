#include "msm/laws/averaged_springs.h"

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "msm/laws/hourglass_correction.h"

namespace springproof {
namespace {

using CellMatrix = Eigen::Matrix<double, 24, 24>;
using CellVector = Eigen::Matrix<double, 24, 1>;
using Row = Eigen::Matrix<double, 1, 24>;

double side(int corner, int axis) { return 2.0 * hexahedron_corners[corner][axis] - 1; }

/// H_pq of a cell, half the sum of s_p s_q u over its corners, as a row per component: d2u / dxi_p dxi_q of the
/// trilinear field in the middle of the cell.
Row second_difference(int p, int q, int component) {
  Row row = Row::Zero();
  for (int n = 0; n < 8; ++n) row[3 * n + component] = side(n, p) * side(n, q) / 2;
  return row;
}

Row third_difference(int component) {
  Row row = Row::Zero();
  for (int n = 0; n < 8; ++n) row[3 * n + component] = side(n, 0) * side(n, 1) * side(n, 2);
  return row;
}

const FilledPart& part_of(const Network& network, std::size_t cell) {
  static const FilledPart full;
  return network.filled.empty() ? full : network.filled[cell];
}

/// Calls act(cell, its stiffness); that of full cells is computed once.
template <class Act>
void for_each_cell(const AveragedSprings& law, const Network& network, const Act& act) {
  const CellMatrix full = law.cell_matrix(network.cell_edge, {});
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const FilledPart& part = part_of(network, c);
    act(network.cells[c], part.fraction == 1 ? full : law.cell_matrix(network.cell_edge, part));
  }
}

}  // namespace

HourglassStiffness HourglassStiffness::of_pattern(double face_to_cube, double nu, bool exact_bending,
                                                  bool exact_torsion) {
  const double pair = paired_stiffness(face_to_cube);
  HourglassStiffness k{1, pair, pair, 1.5 - 2 * pair};
  if (exact_bending) {
    k.bending = 1 / (3 * (1 - nu));
    k.coupling = nu * k.bending;
  }
  if (exact_torsion) k.torsion = 1.0 / 6;
  if (exact_bending && exact_torsion) k.warping = 2.3 / 18;  // of a brick whose edges' moments are exact but for nu
  return k;
}

std::array<Vec3, 8> mean_gradients(double edge, const FilledPart& part) {
  std::array<Vec3, 8> g;
  for (int n = 0; n < 8; ++n)
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const double sj = side(n, j), sk = side(n, k);
      g[n][i] = side(n, i) / edge * (0.25 + (sj * part.mean[j] + sk * part.mean[k]) / 2 + sj * sk * part.mixed[i]);
    }
  return g;
}

Eigen::Matrix<double, 24, 1> volume_gradient(double edge, const FilledPart& part) {
  const std::array<Vec3, 8> g = mean_gradients(edge, part);
  Eigen::Matrix<double, 24, 1> b;
  for (int n = 0; n < 8; ++n) b.segment<3>(3 * n) = part.fraction * edge * edge * edge * g[n];
  return b;
}

Eigen::Matrix<double, 24, 24> AveragedSprings::cell_matrix(double l, const FilledPart& part) const {
  const double G = shear_modulus, alpha = part.fraction, volume = alpha * l * l * l;
  const double bulk = lame_lambda + 2 * G / 3;
  const Vec3& c = part.mean;
  const auto H = second_difference;

  // Strain of the mean gradient; for the deviator shifted by assumed second derivatives q_i = d2u / dxi_i^2.
  const std::array<Vec3, 8> g = mean_gradients(l, part);
  Row normal[3], shear[3], trace = Row::Zero();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    normal[i].setZero();
    shear[i].setZero();
    for (int n = 0; n < 8; ++n) {
      normal[i][3 * n + i] = g[n][i];
      shear[i][3 * n + j] = g[n][k];
      shear[i][3 * n + k] = g[n][j];
    }
    trace += normal[i];
  }
  if (shift > 0)
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      normal[i] -= shift * c[i] / l * contraction * (H(i, j, j) + H(i, k, k));
      shear[i] -= shift / l * (c[j] * H(j, k, j) + c[k] * H(k, j, k));
    }

  CellMatrix K = volume * bulk * trace.transpose() * trace;
  const Row mean = (normal[0] + normal[1] + normal[2]) / 3;
  for (int i = 0; i < 3; ++i) {
    const Row deviator = normal[i] - mean;
    K += volume * G * (2 * deviator.transpose() * deviator + shear[i].transpose() * shear[i]);
  }

  Vec3 rho;
  for (int i = 0; i < 3; ++i) rho[i] = std::max(12 * part.variance[i], least_variance);
  const double unit = alpha * G * l / 2;
  // At the centroid: second differences of the trilinear field vary along the third axis.
  const auto H_at = [&](int p, int q, int component) -> Row {
    return H(p, q, component) + c[3 - p - q] * third_difference(component);
  };
  for (int y = 0; y < 3; ++y) {  // the normal of the neutral plane
    const int z = (y + 1) % 3, x = (y + 2) % 3;
    const Row k1 = H_at(x, y, x), k2 = H_at(y, z, z);
    K += unit * rho[y] *
         (hourglass.bending * (k1.transpose() * k1 + k2.transpose() * k2) +
          hourglass.coupling * (k1.transpose() * k2 + k2.transpose() * k1));
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const Row twist = H_at(k, i, j) + H_at(i, j, k);
    K += unit * hourglass.torsion * rho[i] * twist.transpose() * twist;
    const Row warping = third_difference(i);
    K += unit / 4 * hourglass.warping * (0.3 * rho[j] * rho[k] + rho[i] * (rho[j] + rho[k])) / 2.3 *
         warping.transpose() * warping;
  }
  return K;
}

double AveragedSprings::energy(const Network& network, const NodalVectors& x) const {
  double sum = 0;
  for_each_cell(*this, network, [&](const Hexahedron& cell, const CellMatrix& K) {
    const CellVector u = displacement_of(cell, network, x);
    sum += 0.5 * u.dot(K * u);
  });
  return sum;
}

void AveragedSprings::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  for_each_cell(*this, network, [&](const Hexahedron& cell, const CellMatrix& K) {
    const CellVector force = K * displacement_of(cell, network, x);
    for (int n = 0; n < 8; ++n) f.row(cell[n]) -= force.segment<3>(3 * n).transpose();
  });
}

void AveragedSprings::add_tangent(const Network& network, const NodalVectors&, BlockMatrix& K) const {
  for_each_cell(*this, network, [&](const Hexahedron& cell, const CellMatrix& cell_K) {
    for (int m = 0; m < 8; ++m)
      for (int n = 0; n < 8; ++n) K.add(cell[m], cell[n], cell_K.block<3, 3>(3 * m, 3 * n));
  });
}

VolumeChange volume_change(const Network& network, const NodalVectors& u) {
  double volume = 0;
  VolumeChange change{0, 0};
  const std::array<Vec3, 8> of_full = mean_gradients(network.cell_edge, {});
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const FilledPart& part = part_of(network, c);
    const std::array<Vec3, 8> g = part.fraction == 1 ? of_full : mean_gradients(network.cell_edge, part);
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    for (int n = 0; n < 8; ++n) F += u.row(network.cells[c][n]).transpose() * g[n].transpose();
    volume += part.fraction;
    change.first_order += part.fraction * (F.trace() - 3);
    change.exact += part.fraction * (F.determinant() - 1);
  }
  return {change.first_order / volume, change.exact / volume};
}

}  // namespace springproof
