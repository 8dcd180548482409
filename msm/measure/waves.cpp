#include "msm/measure/waves.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "msm/laws/capabilities.h"

namespace springproof {
namespace {

using std::numbers::pi;
using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

CellMatrix stiffness_of_cell(const MassSpringModel& model) {
  if (!can(model, Capability::equal_cells) || model.network.cells.kind() == CellKind::boxes)
    throw std::invalid_argument("plane waves are those of a lattice of cubes");
  return cell_stiffness(model).total;
}

/// Distance of two corners over the edge.
Vec3 apart(int a, int b) {
  Vec3 d;
  for (int axis = 0; axis < 3; ++axis) d[axis] = hexahedron_corners[b][axis] - hexahedron_corners[a][axis];
  return d;
}

/// K(k), k in units of 1/l; real, since cells are symmetric about their centres.
Eigen::Matrix3d symbol(const CellMatrix& cell, const Vec3& k) {
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < 8; ++b) K += std::cos(k.dot(apart(a, b))) * cell.block<3, 3>(3 * a, 3 * b);
  return K;
}

/// Its derivative as k moves along n.
Eigen::Matrix3d symbol_along(const CellMatrix& cell, const Vec3& k, const Vec3& n) {
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < 8; ++b) {
      const Vec3 d = apart(a, b);
      K -= n.dot(d) * std::sin(k.dot(d)) * cell.block<3, 3>(3 * a, 3 * b);
    }
  return K;
}

/// Mass of a wave over rho l^3, and its derivative as k moves along n.
std::pair<double, double> mass_of(const Vec3& k, const Vec3& n, double consistent) {
  double full = 1, relative = 0;
  for (int axis = 0; axis < 3; ++axis) {
    full *= (2 + std::cos(k[axis])) / 3;
    relative -= n[axis] * std::sin(k[axis]) / (2 + std::cos(k[axis]));
  }
  return {consistent * full + 1 - consistent, consistent * full * relative};
}

/// Directions of one of the 48 equal sectors of a cubic lattice.
std::vector<Vec3> directions_of_sector() {
  std::vector<Vec3> all;
  constexpr int fineness = 6;
  for (int j = 0; j <= fineness; ++j)
    for (int k = 0; k <= j; ++k) all.push_back(Vec3(fineness, j, k).normalized());
  return all;
}

/// K(k) of least eigenvalue over measure(k), k in units of pi/l, wherever that is more than 0, of the waves of a sector
/// with their last component up to last(j).
template <class Measure, class Last>
SoftestWave softest_of(const CellMatrix& cell, int fineness, const Last& last, const Measure& measure) {
  SoftestWave softest{std::numeric_limits<double>::infinity(), Vec3::Zero()};
  for (int i = 0; i <= fineness; ++i)
    for (int j = 0; j <= i; ++j)
      for (int k = 0; k <= last(j); ++k) {
        const Vec3 at = Vec3(i, j, k) / fineness;
        const double unit = measure(at);
        if (!(unit > 0)) continue;
        const double least = Solver(symbol(cell, pi * at), Eigen::EigenvaluesOnly).eigenvalues()[0];
        if (const double stiffness = least / unit; stiffness < softest.stiffness) softest = {stiffness, at};
      }
  return softest;
}

void take_larger(double error, double& worst) {
  if (std::abs(error) > std::abs(worst)) worst = error;
}

}  // namespace

WaveErrors wave_errors(const MassSpringModel& model, double G, double lambda, double cells, double consistent) {
  const CellMatrix cell = stiffness_of_cell(model);
  const double l = model.network.cells.edge, wave = 2 * pi / cells;
  WaveErrors worst{};
  for (const Vec3& n : directions_of_sector()) {
    const Vec3 k = wave * n;
    const auto [mass, mass_along] = mass_of(k, n, consistent);
    const Solver modes(symbol(cell, k));
    const Eigen::Matrix3d K_along = symbol_along(cell, k, n);
    Eigen::Index along = 0;
    (modes.eigenvectors().transpose() * n).cwiseAbs().maxCoeff(&along);
    for (Eigen::Index m = 0; m < 3; ++m) {
      const Vec3 u = modes.eigenvectors().col(m);
      const double modulus = m == along ? lambda + 2 * G : G, squared = modes.eigenvalues()[m] / mass,  // of frequency
          velocity = std::sqrt(modulus * l);  // of the solid, in the same units
      const double phase = std::sqrt(squared) / wave;
      const double group = (u.dot(K_along * u) - squared * mass_along) / (2 * mass * std::sqrt(squared));
      take_larger(phase / velocity - 1, m == along ? worst.phase.longitudinal : worst.phase.transverse);
      take_larger(group / velocity - 1, m == along ? worst.group.longitudinal : worst.group.transverse);
    }
  }
  return worst;
}

SoftestWave softest_wave(const MassSpringModel& model, double G) {
  const auto unit = [&](const Vec3& at) { return at.norm() < 0.5 ? 0 : G * model.network.cells.edge; };
  return softest_of(
      stiffness_of_cell(model), 12, [](int j) { return j; }, unit);
}

SoftestWave weakest_wave(const CellMatrix& tangent, double unit) {
  const auto steepness = [&](const Vec3& at) { return unit * (2 - 2 * (pi * at).array().cos()).sum(); };
  return softest_of(
      tangent, 8, [](int) { return 8; }, steepness);
}

}  // namespace springproof
