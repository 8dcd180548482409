#include "msm/laws/macro_springs.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "meshes/voxels/triquadratic.h"
#include "msm/laws/macro_points.h"
#include "msm/laws/macro_pressures.h"

namespace springproof {
namespace {

using Nodes = Eigen::Matrix<double, 3, 27>;
using Modes = Eigen::Vector4d;

/// State of a macro-cell.
struct Deformed {
  double edge;  ///< of a cube [m]
  MacroPoints all;
  std::span<const MacroPoint> points = all.points;
  double volume = all.volume;  ///< of the body in the cell at rest [m^3]
  std::vector<Eigen::Matrix3d> F;
  std::vector<double> J, theta;
  std::vector<double> pressure;  ///< U'(theta), projected, at the points [1]
  std::vector<VolumeDensity> U;  ///< of theta
  bool inverted = false;

  Deformed(const MacroSprings& law, const Network& network, std::size_t cell, const NodalVectors& x)
      : edge(network.cell_edge), all(macro_points(network, cell)) {
    const Nodes at = at_nodes(network.macro_cells[cell], x);
    Modes mean = Modes::Zero(), slope = Modes::Zero();
    for (const MacroPoint& p : points) {
      F.emplace_back(at * p.gradient.transpose() / edge);
      J.push_back(F.back().determinant());
      mean += p.share * J.back() * p.modes;
      inverted |= !(J.back() > 0);
    }
    for (const MacroPoint& p : points) {
      theta.push_back(mean.dot(p.modes));
      inverted |= !(theta.back() > 0);
    }
    if (inverted) return;
    for (std::size_t q = 0; q < points.size(); ++q) {
      U.push_back(volume_term(law.curve, theta[q]));
      slope += points[q].share * U[q].slope * points[q].modes;
    }
    for (const MacroPoint& p : points) pressure.push_back(slope.dot(p.modes));
  }

  /// dJ/dF
  Eigen::Matrix3d cofactors(std::size_t q) const { return J[q] * F[q].inverse().transpose(); }
};

/// d2J/dF2, index of F(i, j) i + 3 j.
Matrix9 curvature_of_volume(const Eigen::Matrix3d& F) {
  Matrix9 A = Matrix9::Zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int k = (i + 1) % 3, l = (j + 1) % 3, m = (i + 2) % 3, n = (j + 2) % 3;
      // F(i,j) F(k,l) F(m,n) has sign +, F(i,j) F(k,n) F(m,l) sign -.
      A(i + 3 * j, k + 3 * l) = A(k + 3 * l, i + 3 * j) = F(m, n);
      A(i + 3 * j, k + 3 * n) = A(k + 3 * n, i + 3 * j) = -F(m, l);
    }
  return A;
}

/// K += B^T T B, B the derivatives of F to the positions of nodes with these gradients.
void add_point(const Matrix9& T, const Nodes& gradient, Eigen::Matrix<double, 81, 81>& K) {
  for (int b = 0; b < 27; ++b) {
    Eigen::Matrix<double, 9, 3> column = Eigen::Matrix<double, 9, 3>::Zero();
    for (int l = 0; l < 3; ++l) column += gradient(l, b) * T.middleCols<3>(3 * l);
    for (int a = 0; a < 27; ++a) {
      Eigen::Matrix3d block = gradient(0, a) * column.topRows<3>();
      block += gradient(1, a) * column.middleRows<3>(3);
      block += gradient(2, a) * column.bottomRows<3>();
      K.block<3, 3>(3 * a, 3 * b) += block;
    }
  }
}

/// Second derivatives with the pressure(q) [Pa] of each point.
template <class Pressure>
MacroTangent tangent_of(const MacroSprings& law, const Deformed& s, const Pressure& pressure) {
  MacroTangent K;
  K.springs.setConstant(s.inverted ? std::numeric_limits<double>::quiet_NaN() : 0);
  K.gradient.setZero();
  K.curvature.setZero();
  for (std::size_t q = 0; q < s.points.size() && !s.inverted; ++q) {
    const MacroPoint& p = s.points[q];
    const Matrix9 T = distortion_energy(law.curve, law.shear_modulus, s.F[q], Derivative::second).tangent +
                      pressure(q) * curvature_of_volume(s.F[q]);
    add_point(s.volume * p.share * T, p.gradient / s.edge, K.springs);
    const Nodes of_volume = p.share / s.edge * s.cofactors(q) * p.gradient;
    K.gradient += p.modes * Eigen::Map<const Eigen::Matrix<double, 1, 81>>(of_volume.data());
    K.curvature += s.volume * p.share * s.U[q].curvature * p.modes * p.modes.transpose();
  }
  return K;
}

/// dE/dx of the nodes [N], likewise.
template <class Pressure>
Nodes gradient_of(const MacroSprings& law, const Deformed& s, const Pressure& pressure) {
  Nodes gradient = Nodes::Constant(s.inverted ? std::numeric_limits<double>::quiet_NaN() : 0);
  for (std::size_t q = 0; q < s.points.size() && !s.inverted; ++q) {
    const MacroPoint& p = s.points[q];
    const Eigen::Matrix3d P = distortion_energy(law.curve, law.shear_modulus, s.F[q], Derivative::first).stress +
                              pressure(q) * s.cofactors(q);
    gradient += s.volume * p.share / s.edge * P * p.gradient;
  }
  return gradient;
}

/// Difference of the displacements of two neighbours, each continued over the other, at their 54 Gauss points: their
/// quadratic form in the nodes of the lower one, then of the upper; the mean of its square over a cell, twice.
const Eigen::Matrix<double, 54, 54>& difference_of_neighbours(int axis) {
  static const auto all = [] {
    std::array<Eigen::Matrix<double, 54, 54>, 3> of_axis;
    Network full;
    full.cell_edge = 1;
    for (int d = 0; d < 3; ++d) {
      of_axis[d].setZero();
      for (const MacroPoint& p : macro_points(full, 0).points)
        for (const int side : {0, 1}) {
          Vec3 in_lower = p.at, in_upper = p.at;
          (side ? in_lower : in_upper)[d] += side ? 2 : -2;
          const auto lower = triquadratic_weights(in_lower), upper = triquadratic_weights(in_upper);
          Eigen::Matrix<double, 54, 1> row;
          for (int n = 0; n < 27; ++n) row[n] = lower[n], row[27 + n] = -upper[n];
          of_axis[d] += p.share * row * row.transpose();
        }
    }
    return of_axis;
  }();
  return all[axis];
}

/// Positions of the nodes of both cells of a face, from one of them: round-off grows with their distance.
Eigen::Matrix<double, 3, 54> positions_of(const Network& network, const MacroFace& face, const NodalVectors& x) {
  Eigen::Matrix<double, 3, 54> at;
  at << at_nodes(network.macro_cells[face.lower], x), at_nodes(network.macro_cells[face.upper], x);
  return at.colwise() - Vec3(at.col(13));
}

}  // namespace

double MacroSprings::energy(const Network& network, const NodalVectors& x) const {
  double sum = 0;
  for (std::size_t c = 0; c < network.macro_cells.size(); ++c) {
    const Deformed s(*this, network, c, x);
    if (s.inverted) return std::numeric_limits<double>::infinity();
    for (std::size_t q = 0; q < s.points.size(); ++q)
      sum +=
          s.volume * s.points[q].share *
          (distortion_energy(curve, shear_modulus, s.F[q], Derivative::none).value + volume_modulus() * s.U[q].value);
  }
  for (const MacroFace& face : network.macro_faces) {
    const auto at = positions_of(network, face, x);
    sum += bond_stiffness(network) / 2 * (at * difference_of_neighbours(face.axis)).cwiseProduct(at).sum();
  }
  return sum;
}

void MacroSprings::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  for (std::size_t c = 0; c < network.macro_cells.size(); ++c) {
    const Deformed s(*this, network, c, x);
    const Nodes gradient = gradient_of(*this, s, [&](std::size_t q) { return volume_modulus() * s.pressure[q]; });
    for (int n = 0; n < 27; ++n) f.row(network.macro_cells[c][n]) -= gradient.col(n).transpose();
  }
  add_bond_forces(network, x, f);
}

void MacroSprings::add_bond_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  for (const MacroFace& face : network.macro_faces) {
    const Eigen::Matrix<double, 3, 54> gradient =
        bond_stiffness(network) * positions_of(network, face, x) * difference_of_neighbours(face.axis);
    for (int n = 0; n < 27; ++n) {
      f.row(network.macro_cells[face.lower][n]) -= gradient.col(n).transpose();
      f.row(network.macro_cells[face.upper][n]) -= gradient.col(27 + n).transpose();
    }
  }
}

MacroTangent MacroSprings::tangent(const Network& network, std::size_t cell, const NodalVectors& x) const {
  const Deformed s(*this, network, cell, x);
  return tangent_of(*this, s, [&](std::size_t q) { return volume_modulus() * s.pressure[q]; });
}

void MacroSprings::add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const {
  for (std::size_t c = 0; c < network.macro_cells.size(); ++c) {
    MacroTangent of_cell = tangent(network, c, x);
    of_cell.springs += volume_modulus() * of_cell.gradient.transpose() * of_cell.curvature * of_cell.gradient;
    add_to(K, network.macro_cells[c], of_cell.springs);
  }
  add_bonds(network, K);
}

void MacroSprings::add_bonds(const Network& network, BlockMatrix& K) const {
  const double k = bond_stiffness(network);
  for (const MacroFace& face : network.macro_faces) {
    const auto& S = difference_of_neighbours(face.axis);
    const auto node = [&](int n) { return network.macro_cells[n < 27 ? face.lower : face.upper][n % 27]; };
    for (int a = 0; a < 54; ++a)
      for (int b = 0; b < 54; ++b) K.add(node(a), node(b), k * S(a, b) * Eigen::Matrix3d::Identity());
  }
}

MacroPressureForm pressure_form(const MacroSprings& law, const Network& network, std::size_t cell,
                                const NodalVectors& x, const Eigen::Vector4d& pressures) {
  const Deformed s(law, network, cell, x);
  const double of_springs = springs_volume_modulus(law.curve, law.shear_modulus);
  const auto pressure = [&](std::size_t q) {
    return of_springs * s.pressure[q] + pressures.dot(s.points[q].modes) / s.volume;
  };
  MacroPressureForm form{tangent_of(law, s, pressure), {}, Eigen::Vector4d::Zero()};
  MacroTangent& K = form.tangent;
  K.springs += of_springs * K.gradient.transpose() * K.curvature * K.gradient;
  const Nodes gradient = gradient_of(law, s, pressure);
  form.gradient = Eigen::Map<const Eigen::Matrix<double, 81, 1>>(gradient.data());
  for (std::size_t q = 0; q < s.points.size() && !s.inverted; ++q)
    form.slope += s.volume * s.points[q].share * s.U[q].slope * s.points[q].modes;
  return form;
}

void add_to(BlockMatrix& K, const MacroCell& cell, const Eigen::Matrix<double, 81, 81>& matrix) {
  for (int a = 0; a < 27; ++a)
    for (int b = 0; b < 27; ++b) K.add(cell[a], cell[b], matrix.block<3, 3>(3 * a, 3 * b));
}

}  // namespace springproof
