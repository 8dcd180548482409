#include "msm/laws/hourglass_correction.h"

#include <cmath>

#include "msm/cells/cell_corners.h"

namespace springproof {
namespace {

using CellVector = Eigen::Matrix<double, 24, 1>;

/// Unit displacement of axis `component` in the hourglass pattern xi_p xi_q (xi = +-1 at the corners).
CellVector hourglass(int component, int p, int q) {
  CellVector h = CellVector::Zero();
  for (int n = 0; n < 8; ++n) h[3 * n + component] = corner_side(n, p) * corner_side(n, q) / std::sqrt(8.0);
  return h;
}

/// Of the materials.
std::vector<Eigen::Matrix<double, 24, 24>> cell_matrices(const HourglassCorrection& law, double edge) {
  std::vector<Eigen::Matrix<double, 24, 24>> all = {law.cell_matrix(edge)};
  for (const HourglassCorrection& other : law.regions) all.push_back(other.cell_matrix(edge));
  return all;
}

}  // namespace

double paired_stiffness(double A) { return std::isinf(A) ? 0.5 : 3 * A / (2 * (4 + 3 * A)); }

HourglassCorrection::Stiffness HourglassCorrection::stiffness(double edge) const {
  const double Gl = shear_modulus * edge, nu = poisson_ratio, pair = paired_stiffness(face_to_cube);
  Stiffness k = {Gl * (1 / (3 * (1 - nu)) - 1), Gl * (nu / (3 * (1 - nu)) - pair)};
  if (!torsion) return k;
  const double paired = Gl * (1.0 / 6 - pair), symmetric = Gl * (2.0 / 3 - 4 * pair);
  k.torsion = paired;
  k.torsion_coupling = (symmetric - paired) / 3;
  return k;
}

Eigen::Matrix<double, 24, 24> HourglassCorrection::cell_matrix(double edge) const {
  const Stiffness k = stiffness(edge);
  Eigen::Matrix<double, 24, 24> K = Eigen::Matrix<double, 24, 24>::Zero();
  for (int y = 0; y < 3; ++y) {
    const int p = (y + 1) % 3, q = (y + 2) % 3;
    const CellVector hp = hourglass(p, p, y), hq = hourglass(q, q, y);
    K += k.bending * (hp * hp.transpose() + hq * hq.transpose()) +
         k.coupling * (hp * hq.transpose() + hq * hp.transpose());
  }
  if (!torsion) return K;
  for (int m = 0; m < 3; ++m)
    for (int n = 0; n < 3; ++n) {
      const double c = (m == n ? k.torsion : 0.0) + k.torsion_coupling;
      K += c * hourglass(m, (m + 1) % 3, (m + 2) % 3) * hourglass(n, (n + 1) % 3, (n + 2) % 3).transpose();
    }
  return K;
}

double HourglassCorrection::energy(const Network& network, const NodalVectors& x) const {
  const auto K = cell_matrices(*this, network.cells.edge);
  double sum = 0;
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const CellVector u = displacement_of(network.cells.corners[c], network, x);
    sum += 0.5 * u.dot(K[network.cells.material(c)] * u);
  }
  return sum;
}

void HourglassCorrection::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  const auto K = cell_matrices(*this, network.cells.edge);
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const Hexahedron& cell = network.cells.corners[c];
    subtract(CellVector(K[network.cells.material(c)] * displacement_of(cell, network, x)), cell, f);
  }
}

void HourglassCorrection::add_tangent(const Network& network, const NodalVectors&, BlockMatrix& K) const {
  const auto of_materials = cell_matrices(*this, network.cells.edge);
  for (std::size_t c = 0; c < network.cells.size(); ++c)
    add_cell(of_materials[network.cells.material(c)], network.cells.corners[c], K);
}

}  // namespace springproof
