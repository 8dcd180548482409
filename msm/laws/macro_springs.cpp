#include "msm/laws/macro_springs.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "msm/laws/macro_pressures.h"

namespace springproof {
namespace {

constexpr int points = 27;
using Nodes = Eigen::Matrix<double, 3, 27>;
using Modes = Eigen::Vector4d;

/// A Gauss point of the macro-cell [-1, 1]^3.
struct Point {
  double share;    ///< of the volume
  Nodes gradient;  ///< of the nodes' triquadratic functions
  Modes modes;     ///< 1, sqrt(3) x, sqrt(3) y, sqrt(3) z: orthonormal in the mean over the cell
};

const std::array<Point, points>& gauss_points() {
  static const std::array<Point, points> all = [] {
    const double r = std::sqrt(0.6), at[3] = {-r, 0, r}, weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    const auto value = [](int node, double t) {
      return node == 0 ? t * (t - 1) / 2 : node == 1 ? 1 - t * t : t * (t + 1) / 2;
    };
    const auto slope = [](int node, double t) { return node == 0 ? t - 0.5 : node == 1 ? -2 * t : t + 0.5; };
    std::array<Point, points> p;
    for (int q = 0; q < points; ++q) {
      const int i = q % 3, j = q / 3 % 3, k = q / 9;
      const double x = at[i], y = at[j], z = at[k];
      p[q].share = weight[i] * weight[j] * weight[k];
      p[q].modes << 1, std::sqrt(3) * x, std::sqrt(3) * y, std::sqrt(3) * z;
      for (int n = 0; n < 27; ++n) {
        const int a = n % 3, b = n / 3 % 3, c = n / 9;
        p[q].gradient.col(n) << slope(a, x) * value(b, y) * value(c, z), value(a, x) * slope(b, y) * value(c, z),
            value(a, x) * value(b, y) * slope(c, z);
      }
    }
    return p;
  }();
  return all;
}

/// State of a macro-cell.
struct Deformed {
  double edge, volume;  ///< of a cube [m], of the cell at rest [m^3]
  std::array<Eigen::Matrix3d, points> F;
  std::array<double, points> J, theta;
  std::array<double, points> pressure;  ///< U'(theta), projected, at the points [1]
  std::array<VolumeDensity, points> U;  ///< of theta
  bool inverted = false;

  Deformed(const MacroSprings& law, const Network& network, const MacroCell& cell, const NodalVectors& x)
      : edge(network.cell_edge), volume(8 * network.cell_volume()) {
    Nodes at;
    for (int n = 0; n < 27; ++n) at.col(n) = x.row(cell[n]).transpose();
    const auto& p = gauss_points();
    Modes mean = Modes::Zero(), slope = Modes::Zero();
    for (int q = 0; q < points; ++q) {
      F[q] = at * p[q].gradient.transpose() / edge;
      J[q] = F[q].determinant();
      mean += p[q].share * J[q] * p[q].modes;
      inverted |= !(J[q] > 0);
    }
    for (int q = 0; q < points; ++q) {
      theta[q] = mean.dot(p[q].modes);
      inverted |= !(theta[q] > 0);
    }
    if (inverted) return;
    for (int q = 0; q < points; ++q) {
      U[q] = volume_term(law.curve, theta[q]);
      slope += p[q].share * U[q].slope * p[q].modes;
    }
    for (int q = 0; q < points; ++q) pressure[q] = slope.dot(p[q].modes);
  }

  /// dJ/dF
  Eigen::Matrix3d cofactors(int q) const { return J[q] * F[q].inverse().transpose(); }
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
  for (int q = 0; q < points && !s.inverted; ++q) {
    const Point& p = gauss_points()[q];
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
  for (int q = 0; q < points && !s.inverted; ++q) {
    const Point& p = gauss_points()[q];
    const Eigen::Matrix3d P = distortion_energy(law.curve, law.shear_modulus, s.F[q], Derivative::first).stress +
                              pressure(q) * s.cofactors(q);
    gradient += s.volume * p.share / s.edge * P * p.gradient;
  }
  return gradient;
}

}  // namespace

double MacroSprings::energy(const Network& network, const NodalVectors& x) const {
  double sum = 0;
  for (const MacroCell& cell : network.macro_cells) {
    const Deformed s(*this, network, cell, x);
    if (s.inverted) return std::numeric_limits<double>::infinity();
    for (int q = 0; q < points; ++q)
      sum +=
          s.volume * gauss_points()[q].share *
          (distortion_energy(curve, shear_modulus, s.F[q], Derivative::none).value + volume_modulus() * s.U[q].value);
  }
  return sum;
}

void MacroSprings::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  for (const MacroCell& cell : network.macro_cells) {
    const Deformed s(*this, network, cell, x);
    const Nodes gradient = gradient_of(*this, s, [&](int q) { return volume_modulus() * s.pressure[q]; });
    for (int n = 0; n < 27; ++n) f.row(cell[n]) -= gradient.col(n).transpose();
  }
}

MacroTangent MacroSprings::tangent(const Network& network, const MacroCell& cell, const NodalVectors& x) const {
  const Deformed s(*this, network, cell, x);
  return tangent_of(*this, s, [&](int q) { return volume_modulus() * s.pressure[q]; });
}

void MacroSprings::add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const {
  for (const MacroCell& cell : network.macro_cells) {
    MacroTangent of_cell = tangent(network, cell, x);
    of_cell.springs += volume_modulus() * of_cell.gradient.transpose() * of_cell.curvature * of_cell.gradient;
    add_to(K, cell, of_cell.springs);
  }
}

MacroPressureForm pressure_form(const MacroSprings& law, const Network& network, const MacroCell& cell,
                                const NodalVectors& x, const Eigen::Vector4d& pressures) {
  const Deformed s(law, network, cell, x);
  const double of_springs = springs_volume_modulus(law.curve, law.shear_modulus);
  const auto pressure = [&](int q) {
    return of_springs * s.pressure[q] + pressures.dot(gauss_points()[q].modes) / s.volume;
  };
  MacroPressureForm form{tangent_of(law, s, pressure), {}, Eigen::Vector4d::Zero()};
  MacroTangent& K = form.tangent;
  K.springs += of_springs * K.gradient.transpose() * K.curvature * K.gradient;
  const Nodes gradient = gradient_of(law, s, pressure);
  form.gradient = Eigen::Map<const Eigen::Matrix<double, 81, 1>>(gradient.data());
  for (int q = 0; q < points && !s.inverted; ++q)
    form.slope += s.volume * gauss_points()[q].share * s.U[q].slope * gauss_points()[q].modes;
  return form;
}

void add_to(BlockMatrix& K, const MacroCell& cell, const Eigen::Matrix<double, 81, 81>& matrix) {
  for (int a = 0; a < 27; ++a)
    for (int b = 0; b < 27; ++b) K.add(cell[a], cell[b], matrix.block<3, 3>(3 * a, 3 * b));
}

VolumeChange volume_change_of_macro_cells(const Network& network, const NodalVectors& u) {
  VolumeChange change{0, 0};
  for (const MacroCell& cell : network.macro_cells) {
    Nodes at;
    for (int n = 0; n < 27; ++n) at.col(n) = u.row(cell[n]).transpose();
    for (const Point& p : gauss_points()) {
      const Eigen::Matrix3d H = at * p.gradient.transpose() / network.cell_edge;
      change.exact += p.share * ((Eigen::Matrix3d::Identity() + H).determinant() - 1);
      change.first_order += p.share * H.trace();
    }
  }
  change.exact /= static_cast<double>(network.macro_cells.size());
  change.first_order /= static_cast<double>(network.macro_cells.size());
  return change;
}

}  // namespace springproof
