#include "msm/laws/averaged_springs.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "msm/cells/cell_corners.h"
#include "msm/laws/hourglass_correction.h"

namespace springproof {
namespace {

using CellMatrix = Eigen::Matrix<double, 24, 24>;
using CellVector = Eigen::Matrix<double, 24, 1>;
using Row = Eigen::Matrix<double, 1, 24>;

/// H_pq of a cell, half the sum of s_p s_q u over its corners, as a row per component: d2u / dxi_p dxi_q of the
/// trilinear field in the middle of the cell.
Row second_difference(int p, int q, int component) {
  Row row = Row::Zero();
  for (int n = 0; n < 8; ++n) row[3 * n + component] = corner_side(n, p) * corner_side(n, q) / 2;
  return row;
}

using Pattern = Eigen::Matrix<double, 8, 4>;
using HourglassMatrix = Eigen::Matrix<double, 12, 12>;
using HourglassRow = Eigen::Matrix<double, 1, 12>;

/// Patterns of the corners: d2/dxi_q dxi_r of the trilinear field in the middle of the cell, q and r the axes other
/// than 0, 1, 2; and the third difference.
const Pattern& patterns() {
  static const Pattern all = [] {
    Pattern h;
    for (int n = 0; n < 8; ++n) {
      const double x = corner_side(n, 0), y = corner_side(n, 1), z = corner_side(n, 2);
      h.row(n) << y * z / 2, z * x / 2, x * y / 2, x * y * z;
    }
    return h;
  }();
  return all;
}

/// Components in the patterns, 3 * pattern + axis, of displacements of the corners.
Eigen::Matrix<double, 12, 24> components_of_patterns() {
  Eigen::Matrix<double, 12, 24> rows = Eigen::Matrix<double, 12, 24>::Zero();
  for (int n = 0; n < 8; ++n)
    for (int m = 0; m < 4; ++m)
      for (int i = 0; i < 3; ++i) rows(3 * m + i, 3 * n + i) = patterns()(n, m);
  return rows;
}

/// 12 S_i, in the square of the cell's edge.
Vec3 second_moments(const CellShape& cell) {
  const Vec3 rho = (12 * cell.part.variance).cwiseMax(AveragedSprings::least_variance);
  return rho.cwiseProduct(cell.proportions.cwiseAbs2());
}

/// Quadratic form of 3 * pattern + axis, the stiffness of a cell's hourglass springs [N/m].
HourglassMatrix hourglass_matrix(const AveragedSprings& law, const CellShape& cell) {
  const auto third = [](int axis) -> HourglassRow { return HourglassRow::Unit(9 + axis); };
  // At the centroid: second differences of the trilinear field vary along the third axis.
  const auto second = [&](int p, int q, int axis) -> HourglassRow {
    const int r = 3 - p - q;
    return cell.proportions[r] * (HourglassRow::Unit(3 * r + axis) + cell.part.mean[r] * third(axis));
  };
  const Vec3 rho = second_moments(cell);
  const double unit = cell.part.fraction * law.shear_modulus * cell.edge / 2;
  HourglassMatrix D = HourglassMatrix::Zero();
  for (int y = 0; y < 3; ++y) {  // the normal of the neutral plane
    const int z = (y + 1) % 3, x = (y + 2) % 3;
    const HourglassRow k1 = second(x, y, x), k2 = second(y, z, z);
    D += unit * rho[y] *
         (law.hourglass.bending * (k1.transpose() * k1 + k2.transpose() * k2) +
          law.hourglass.coupling * (k1.transpose() * k2 + k2.transpose() * k1));
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const HourglassRow twist = second(k, i, j) + second(i, j, k);
    D += unit * law.hourglass.torsion * rho[i] * twist.transpose() * twist;
    const HourglassRow own = second(j, k, i);
    D += unit * law.hourglass.twist * (rho[j] + rho[k]) / 2 * own.transpose() * own;
    D += unit / 4 * law.hourglass.warping * (0.3 * rho[j] * rho[k] + rho[i] * (rho[j] + rho[k])) / 2.3 *
         third(i).transpose() * third(i);
  }
  return D;
}

using InPatterns = Eigen::Matrix<double, 3, 4>;  // a vector per pattern

/// The product of hourglass_matrix() with v [N], without the matrix.
InPatterns hourglass_forces(const AveragedSprings& law, const CellShape& cell, const InPatterns& v) {
  const HourglassStiffness& k = law.hourglass;
  const Vec3 &mean = cell.part.mean, &proportions = cell.proportions;
  const Eigen::Matrix3d at_centroid = (v.leftCols<3>() + v.col(3) * mean.transpose()) * proportions.asDiagonal();
  const auto H = [&](int pattern, int axis) { return at_centroid(axis, pattern); };
  const Vec3 rho = second_moments(cell);
  InPatterns w;
  for (int y = 0; y < 3; ++y) {
    const int z = (y + 1) % 3, x = (y + 2) % 3;
    w(x, z) = rho[y] * (k.bending * H(z, x) + k.coupling * H(x, z));
    w(z, x) = rho[y] * (k.bending * H(x, z) + k.coupling * H(z, x));
    w(y, y) = k.torsion * (rho[z] * (H(y, y) + H(x, x)) + rho[x] * (H(y, y) + H(z, z))) +
              k.twist * (rho[z] + rho[x]) / 2 * H(y, y);
    w(y, 3) = k.warping / 4 * (0.3 * rho[z] * rho[x] + rho[y] * (rho[z] + rho[x])) / 2.3 * v(y, 3);
  }
  w.leftCols<3>() *= proportions.asDiagonal();
  w.col(3) += w.leftCols<3>() * mean;
  return cell.part.fraction * law.shear_modulus * cell.edge / 2 * w;
}

/// What the forces of a cell depend on beside the positions of its corners.
struct CellAtRest {
  CellShape shape;
  double volume;     ///< of the filled part [m^3]
  Corners gradient;  ///< mean gradients of the corners' weights [1/m]

  explicit CellAtRest(const CellShape& of) : shape(of), volume(of.volume()), gradient(gradients_at(of)) {}
};

/// State of a cell.
struct Deformed {
  Eigen::Matrix3d F;
  InPatterns q;         ///< the patterns of the positions [m]
  InPatterns v;         ///< F^T q
  InPatterns w;         ///< derivative of the hourglass energy to v [N]
  StrainEnergy strain;  ///< per unit of volume

  Deformed(const AveragedSprings& law, const CellAtRest& cell, const Corners& x, Derivative up_to)
      : F(x * cell.gradient.transpose()),
        q(x * patterns()),
        v(F.transpose() * q),
        w(hourglass_forces(law, cell.shape, v)) {
    if (F.determinant() <= 0) {
      strain.value = std::numeric_limits<double>::infinity();
      strain.stress.setConstant(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    strain = springs_energy(law.curve, law.shear_modulus, F, up_to);
    add_volume_term(law.curve, law.lame_lambda - law.shear_modulus, F, up_to, strain);
  }
};

CellMatrix tangent_of(const CellForm& form, const Deformed& s) {
  // P and its derivative, [9 x 9] of F, to positions of corners.
  const Eigen::Matrix<double, 9, 24> strain_gradient = slope_of_gradient(form.gradient);
  Eigen::Matrix<double, 12, 24> hourglass_gradient;
  for (int a = 0; a < 8; ++a) {
    const Vec3 g = form.gradient.col(a);
    for (int m = 0; m < 4; ++m)
      hourglass_gradient.block<3, 3>(3 * m, 3 * a) = patterns()(a, m) * s.F.transpose() + g * s.q.col(m).transpose();
  }
  CellMatrix K = form.volume * strain_gradient.transpose() * s.strain.tangent * strain_gradient +
                 hourglass_gradient.transpose() * form.hourglass * hourglass_gradient;
  const Eigen::Matrix<double, 8, 8> turned = patterns() * s.w.transpose() * form.gradient;
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < 8; ++b)
      for (int i = 0; i < 3; ++i) K(3 * a + i, 3 * b + i) += turned(a, b) + turned(b, a);
  return K;
}

/// Calls act(corners, make(shape)) for each cell; that of full cells of one size and material is made once.
template <class Make, class Act>
void for_each_cell(const CellSet& cells, const Make& make, const Act& act) {
  std::map<std::pair<double, int>, decltype(make(CellShape{}))> full;
  auto last = full.end();
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!cells.is_full(c)) {
      act(cells.corners[c], make(cells.shape(c)));
      continue;
    }
    const std::pair key(cells.edge_of(c), cells.material(c));
    if (last == full.end() || last->first != key) last = full.find(key);
    if (last == full.end()) last = full.emplace(key, make(cells.shape(c))).first;
    act(cells.corners[c], last->second);
  }
}

template <class Act>
void for_each_at_rest(const CellSet& cells, const Act& act) {
  for_each_cell(
      cells, [](const CellShape& cell) { return CellAtRest(cell); }, act);
}

template <class Act>
void for_each_stiffness(const AveragedSprings& law, const CellSet& cells, const Act& act) {
  for_each_cell(
      cells, [&](const CellShape& cell) { return law.cell_matrix(cell); }, act);
}

}  // namespace

CellForm cell_form(const AveragedSprings& law, const CellShape& cell) {
  return {cell.volume(), gradients_at(cell), hourglass_matrix(law.in(cell.material), cell)};
}

const Eigen::Matrix<double, 8, 4>& corner_patterns() { return patterns(); }

HourglassStiffness HourglassStiffness::of_pattern(double face_to_cube, double nu, bool exact_bending,
                                                  bool exact_torsion, bool slender) {
  const double pair = paired_stiffness(face_to_cube);
  HourglassStiffness k{1, pair, pair, 0, 1.5 - 2 * pair};
  if (exact_bending) {
    k.bending = 1 / (3 * (1 - nu));
    k.coupling = nu * k.bending;
  }
  if (exact_torsion) k.torsion = 1.0 / 6;
  if (exact_bending && exact_torsion) k.warping = 2.3 / 18;  // of a brick whose edges' moments are exact but for nu
  if (slender) {
    k.torsion = 0;
    k.twist = k.warping = 0.1;
  }
  return k;
}

Eigen::Matrix<double, 24, 24> AveragedSprings::cell_matrix(const CellShape& cell) const {
  const AveragedSprings& own = in(cell.material);
  const double G = own.shear_modulus, l = cell.edge, volume = cell.volume();
  const double bulk = own.lame_lambda + 2 * G / 3;
  const Vec3& c = cell.part.mean;
  const auto H = second_difference;

  // Strain of the mean gradient; for the deviator shifted by assumed second derivatives q_i = d2u / dxi_i^2.
  const std::array<Vec3, 8> g = mean_gradients(cell);
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
      normal[i] -= shift * c[i] / l * own.contraction * (H(i, j, j) + H(i, k, k));
      shear[i] -= shift / l * (c[j] * H(j, k, j) + c[k] * H(k, j, k));
    }

  CellMatrix K = volume * bulk * trace.transpose() * trace;
  const Row mean = (normal[0] + normal[1] + normal[2]) / 3;
  for (int i = 0; i < 3; ++i) {
    const Row deviator = normal[i] - mean;
    K += volume * G * (2 * deviator.transpose() * deviator + shear[i].transpose() * shear[i]);
  }

  const Eigen::Matrix<double, 12, 24> of_patterns = components_of_patterns();
  K += of_patterns.transpose() * hourglass_matrix(own, cell) * of_patterns;
  return K;
}

const char* AveragedSprings::lacks(Capability what) const {
  using enum Capability;
  const bool by_kernels = what == lattice_kernels || what == gpu || what == cell_kernels;
  if (shift > 0 && (by_kernels || what == energy_momentum || what == relaxation || what == large_displacements))
    return "with a shift are linear in the displacement";
  if (by_kernels && (curve == StrainCurve::springs_hencky || curve == StrainCurve::springs_neo_hooke))
    return "of single springs at large strain have no kernels";
  return nullptr;
}

double AveragedSprings::energy(const Network& network, const NodalVectors& x) const {
  double sum = 0;
  if (shift > 0)
    for_each_stiffness(*this, network.cells, [&](const Hexahedron& cell, const CellMatrix& K) {
      const CellVector u = displacement_of(cell, network, x);
      sum += 0.5 * u.dot(K * u);
    });
  else
    for_each_at_rest(network.cells, [&](const Hexahedron& corners, const CellAtRest& cell) {
      const Deformed s(in(cell.shape.material), cell, corners_at(corners, x), Derivative::none);
      sum += cell.volume * s.strain.value + 0.5 * s.v.cwiseProduct(s.w).sum();
    });
  return sum;
}

void AveragedSprings::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  if (shift > 0)
    for_each_stiffness(*this, network.cells, [&](const Hexahedron& cell, const CellMatrix& K) {
      subtract(CellVector(K * displacement_of(cell, network, x)), cell, f);
    });
  else
    for_each_at_rest(network.cells, [&](const Hexahedron& corners, const CellAtRest& cell) {
      const Deformed s(in(cell.shape.material), cell, corners_at(corners, x), Derivative::first);
      const Eigen::Matrix3d stress = cell.volume * s.strain.stress + s.q * s.w.transpose();
      const InPatterns of_patterns = s.F * s.w;
      subtract(Corners(stress * cell.gradient + of_patterns * patterns().transpose()), corners, f);
    });
}

void AveragedSprings::add_viscous_forces(const Network& network, const NodalVectors& x, const NodalVectors& v,
                                         double time, NodalVectors& f) const {
  if (shift > 0)
    return for_each_stiffness(*this, network.cells, [&](const Hexahedron& cell, const CellMatrix& K) {
      const Corners rate = corners_at(cell, v);
      subtract(CellVector(time * K * Eigen::Map<const CellVector>(rate.data())), cell, f);
    });
  for_each_at_rest(network.cells, [&](const Hexahedron& corners, const CellAtRest& cell) {
    const Corners at = corners_at(corners, x), rate = corners_at(corners, v);
    const Eigen::Matrix3d F = at * cell.gradient.transpose(), F_rate = rate * cell.gradient.transpose();
    const Eigen::Matrix3d twice = F.transpose() * F_rate + F_rate.transpose() * F;  // 2 E'
    const Eigen::Matrix3d inverse = F.inverse();
    const AveragedSprings& own = in(cell.shape.material);
    const Eigen::Matrix3d P =
        own.shear_modulus * F * twice + own.lame_lambda * (F_rate * inverse).trace() * inverse.transpose();
    const InPatterns q = at * patterns();
    const InPatterns w =
        hourglass_forces(own, cell.shape, F_rate.transpose() * q + F.transpose() * (rate * patterns()));
    const Eigen::Matrix3d stress = time * (cell.volume * P + q * w.transpose());
    const InPatterns of_patterns = time * F * w;
    subtract(Corners(stress * cell.gradient + of_patterns * patterns().transpose()), corners, f);
  });
}

void AveragedSprings::add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const {
  const auto add = [&](const Hexahedron& cell, const CellMatrix& cell_K) { add_cell(cell_K, cell, K); };
  if (shift > 0)
    for_each_stiffness(*this, network.cells, add);
  else
    for_each_cell(
        network.cells, [&](const CellShape& cell) { return std::pair(cell_form(*this, cell), CellAtRest(cell)); },
        [&](const Hexahedron& corners, const auto& of) {
          const Deformed s(in(of.second.shape.material), of.second, corners_at(corners, x), Derivative::second);
          add(corners, tangent_of(of.first, s));
        });
}

MixedParts mixed_parts(const AveragedSprings& law) {
  MixedParts parts{law, {}};
  const auto take = [&](AveragedSprings& of) {
    parts.kappa.push_back(std::max(0.0, of.lame_lambda - of.shear_modulus));
    if (parts.kappa.back() > 0) of.lame_lambda = of.shear_modulus;
  };
  take(parts.springs);
  for (AveragedSprings& of : parts.springs.regions) take(of);
  return parts;
}

CellForms::CellForms(const AveragedSprings& law, const CellSet& cells) {
  std::map<std::pair<double, int>, int> full;  // by edge and material
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto make = [&] {
      forms_.push_back(cell_form(law, cells.shape(c)));
      return static_cast<int>(forms_.size()) - 1;
    };
    const std::pair key(cells.edge_of(c), cells.material(c));
    if (!cells.is_full(c))
      of_cell_.push_back(make());
    else if (const auto known = full.find(key); known != full.end())
      of_cell_.push_back(known->second);
    else
      of_cell_.push_back(full[key] = make());
  }
}

}  // namespace springproof
