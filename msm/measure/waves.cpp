#include "msm/measure/waves.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace springproof {
namespace {

using std::numbers::pi;
using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

CellMatrix stiffness_of_cell(const MassSpringModel& model) {
  if (!consists_of_cells(model)) throw std::invalid_argument("plane waves are those of a lattice of cells");
  return cell_stiffness(model).total;
}

/// K(k), k in units of 1/l; real, since cells are symmetric about their centres.
Eigen::Matrix3d symbol(const CellMatrix& cell, const Vec3& k) {
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < 8; ++b) {
      double phase = 0;
      for (int d = 0; d < 3; ++d) phase += k[d] * (hexahedron_corners[b][d] - hexahedron_corners[a][d]);
      K += std::cos(phase) * cell.block<3, 3>(3 * a, 3 * b);
    }
  return K;
}

/// Directions of one of the 48 equal sectors of a cubic lattice.
std::vector<Vec3> directions_of_sector() {
  std::vector<Vec3> all;
  constexpr int fineness = 6;
  for (int j = 0; j <= fineness; ++j)
    for (int k = 0; k <= j; ++k) all.push_back(Vec3(fineness, j, k).normalized());
  return all;
}

void take_larger(double error, double& worst) {
  if (std::abs(error) > std::abs(worst)) worst = error;
}

}  // namespace

PhaseError phase_error(const MassSpringModel& model, double G, double lambda, double cells, double consistent) {
  const CellMatrix cell = stiffness_of_cell(model);
  const double l = model.network.cell_edge, wave = 2 * pi / cells;
  PhaseError worst{0, 0};
  for (const Vec3& n : directions_of_sector()) {
    double full = 1;
    for (const double k : wave* n) full *= (2 + std::cos(k)) / 3;
    const double mass = consistent * full + 1 - consistent;  // over rho l^3
    const Solver modes(symbol(cell, wave * n));
    Eigen::Index along = 0;
    (modes.eigenvectors().transpose() * n).cwiseAbs().maxCoeff(&along);
    for (Eigen::Index m = 0; m < 3; ++m) {
      const double modulus = m == along ? lambda + 2 * G : G;
      const double ratio = std::sqrt(modes.eigenvalues()[m] / (mass * modulus * l * wave * wave));
      take_larger(ratio - 1, m == along ? worst.longitudinal : worst.transverse);
    }
  }
  return worst;
}

SoftestWave softest_wave(const MassSpringModel& model, double G) {
  const CellMatrix cell = stiffness_of_cell(model);
  constexpr int fineness = 12;
  SoftestWave softest{std::numeric_limits<double>::infinity(), Vec3::Zero()};
  for (int i = 0; i <= fineness; ++i)
    for (int j = 0; j <= i; ++j)
      for (int k = 0; k <= j; ++k) {
        const Vec3 at = Vec3(i, j, k) / fineness;
        if (at.norm() < 0.5) continue;
        const double least = Solver(symbol(cell, pi * at), Eigen::EigenvaluesOnly).eigenvalues()[0];
        if (const double stiffness = least / (G * model.network.cell_edge); stiffness < softest.stiffness)
          softest = {stiffness, at};
      }
  return softest;
}

SoftestWave weakest_wave(const CellMatrix& tangent, double unit) {
  constexpr int fineness = 8;
  SoftestWave weakest{std::numeric_limits<double>::infinity(), Vec3::Zero()};
  for (int i = 0; i <= fineness; ++i)
    for (int j = 0; j <= i; ++j)
      for (int k = i == 0 ? 1 : 0; k <= fineness; ++k) {
        const Vec3 at = Vec3(i, j, k) / fineness;
        const double steepness = (2 - 2 * (pi * at).array().cos()).sum();
        const double least = Solver(symbol(tangent, pi * at), Eigen::EigenvaluesOnly).eigenvalues()[0];
        if (const double stiffness = least / (unit * steepness); stiffness < weakest.stiffness)
          weakest = {stiffness, at};
      }
  return weakest;
}

}  // namespace springproof
