#include "msm/cells/filled_volume.h"

#include <Eigen/Dense>
#include <cmath>

namespace springproof {
namespace {

using Gradients = std::array<Vec3, 8>;

Eigen::Matrix3d sum_of(const Hexahedron& cell, const Gradients& g, const NodalVectors& field) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int n = 0; n < 8; ++n) sum += field.row(cell[n]).transpose() * g[n].transpose();
  return sum;
}

}  // namespace

double filled_volume(const Network& network, std::size_t cell) {
  return network.cells.part(cell).fraction * std::pow(network.cells.edge_of(cell), 3);
}

std::array<Vec3, 8> mean_gradients(const CellShape& cell) {
  const FilledPart& part = cell.part;
  Gradients g;
  for (int n = 0; n < 8; ++n)
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const double sj = corner_side(n, j), sk = corner_side(n, k);
      g[n][i] = corner_side(n, i) / (cell.edge * cell.proportions[i]) *
                (0.25 + (sj * part.mean[j] + sk * part.mean[k]) / 2 + sj * sk * part.mixed[i]);
    }
  return g;
}

Eigen::Matrix3d mean_gradient(const Network& network, std::size_t cell, const NodalVectors& field) {
  return sum_of(network.cells.corners[cell], mean_gradients(network.cells.shape(cell)), field);
}

Eigen::Matrix<double, 24, 1> volume_gradient(const CellShape& cell) {
  const Gradients g = mean_gradients(cell);
  Eigen::Matrix<double, 24, 1> b;
  for (int n = 0; n < 8; ++n) b.segment<3>(3 * n) = cell.volume() * g[n];
  return b;
}

CellVolume cell_volume(const Network& network, std::size_t cell, const NodalVectors& x) {
  const Gradients g = mean_gradients(network.cells.shape(cell));
  const Eigen::Matrix3d F = sum_of(network.cells.corners[cell], g, x);
  Eigen::Matrix3d cofactor;
  for (int i = 0; i < 3; ++i) cofactor.col(i) = F.col((i + 1) % 3).cross(F.col((i + 2) % 3));
  const double volume = filled_volume(network, cell);
  CellVolume result{volume * F.determinant(), {}};
  for (int n = 0; n < 8; ++n) result.gradient.segment<3>(3 * n) = volume * cofactor * g[n];
  return result;
}

void add_volume_curvature(const Network& network, std::size_t cell, const NodalVectors& x, double pressure,
                          BlockMatrix& K) {
  const Hexahedron& corners = network.cells.corners[cell];
  const Gradients g = mean_gradients(network.cells.shape(cell));
  const Eigen::Matrix3d F = sum_of(corners, g, x);
  const double scale = pressure * filled_volume(network, cell);
  for (int m = 0; m < 8; ++m)
    for (int n = 0; n < 8; ++n) K.add(corners[m], corners[n], -cross_matrix(scale * F * g[m].cross(g[n])));
}

VolumeChange volume_change(const Network& network, const NodalVectors& u) {
  double volume = 0;
  VolumeChange change{0, 0};
  const Gradients of_full = mean_gradients(network.cells.full());
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const bool known = network.cells.is_full(c) && network.cells.edge_of(c) == network.cells.edge;
    const Eigen::Matrix3d F =
        Eigen::Matrix3d::Identity() +
        sum_of(network.cells.corners[c], known ? of_full : mean_gradients(network.cells.shape(c)), u);
    const double own = filled_volume(network, c);
    volume += own;
    change.first_order += own * (F.trace() - 3);
    change.exact += own * (F.determinant() - 1);
  }
  return {change.first_order / volume, change.exact / volume};
}

}  // namespace springproof
