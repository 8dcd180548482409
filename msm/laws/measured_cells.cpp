#include "msm/laws/measured_cells.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "msm/cells/cell_corners.h"

namespace springproof {
namespace {

using CellMatrix24 = Eigen::Matrix<double, 24, 24>;
using InPatterns = Eigen::Matrix<double, 3, 4>;  // a vector per pattern
using Numbers = Deformations;
using Voigt = Eigen::Matrix<double, 6, 1>;

/// xx, yy, zz, 2 yz, 2 zx, 2 xy of a symmetric matrix.
Voigt strains_of(const Eigen::Matrix3d& e) {
  Voigt v;
  v << e(0, 0), e(1, 1), e(2, 2), 2 * e(1, 2), 2 * e(2, 0), 2 * e(0, 1);
  return v;
}

/// The symmetric matrix whose product with a strain is that of these with strains_of() it.
Eigen::Matrix3d stress_of(const Voigt& s) {
  Eigen::Matrix3d S;
  S << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  return S;
}

// Divided differences of f = ln(x)/2, x > 0.
double divided(double a, double b) {
  const double t = (a - b) / b;
  return t == 0 ? 1 / (2 * b) : std::log1p(t) / (2 * t * b);
}
double divided(double a, double b, double c) {
  if (std::abs(a - b) > std::abs(a - c)) std::swap(b, c);
  if (std::abs(c - b) > std::abs(a - c)) std::swap(a, b);  // now a and c are the farthest
  const double m = (a + b + c) / 3;
  if (std::abs(a - c) > 0.02 * m) return (divided(a, b) - divided(b, c)) / (a - c);
  const double p = (a - m) / m, q = (b - m) / m, r = (c - m) / m;  // Taylor's series about m: p + q + r = 0
  const double second = (p * p + q * q + r * r) / 2, third = p * q * r, fourth = second * second;
  return (-1.0 / 4 - second / 8 + third / 10 - fourth / 12) / (m * m);
}

/// A strain of C = F^T F, and its slope.
struct StrainOfC {
  StrainOfCell measure;
  Vec3 c;                  ///< eigenvalues of C
  Eigen::Matrix3d V;       ///< its eigenvectors
  Eigen::Matrix3d slopes;  ///< divided differences of the strain
  Voigt value;

  StrainOfC(StrainOfCell of, const Eigen::Matrix3d& C) : measure(of) {
    if (measure == StrainOfCell::green_lagrange) {
      value = strains_of((C - Eigen::Matrix3d::Identity()) / 2);
      return;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(C);
    c = eigen.eigenvalues();
    V = eigen.eigenvectors();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) slopes(i, j) = divided(c[i], c[j]);
    value = strains_of(V * (c.array().log() / 2).matrix().asDiagonal() * V.transpose());
  }

  /// S, of the strain, in axes of the eigenvectors.
  Eigen::Matrix3d in_axes(const Voigt& s) const { return V.transpose() * stress_of(s) * V; }
  /// The product of s with the derivative of the strain to C.
  Eigen::Matrix3d stress_of_C(const Voigt& s) const {
    if (measure == StrainOfCell::green_lagrange) return stress_of(s) / 2;
    return V * slopes.cwiseProduct(in_axes(s)) * V.transpose();
  }
};

/// F of a cell and the patterns of its positions.
struct Placed {
  Corners gradient;  ///< of the corners' weights [1/m]
  double edge;
  Eigen::Matrix3d F;
  InPatterns q;  ///< of the positions [m]

  Placed(const CellShape& shape, const Corners& x)
      : gradient(gradients_at(shape)), edge(shape.edge), F(x * gradient.transpose()), q(x * corner_patterns()) {}

  bool inverted() const { return !(F.determinant() > 0); }
  Eigen::Matrix3d C() const { return F.transpose() * F; }
  Numbers deformations(const Voigt& strain) const {
    Numbers y;
    const InPatterns v = F.transpose() * q;
    y << edge * strain, Eigen::Map<const Eigen::Matrix<double, 12, 1>>(v.data());
    return y;
  }
  static InPatterns in_patterns(const Numbers& of) { return Eigen::Map<const InPatterns>(of.data() + 6); }

  /// Of the corners, dE/dx: `stress` = dE/dC, and w = dE/dv of the patterns.
  Corners force(const Eigen::Matrix3d& stress, const InPatterns& w) const {
    return (2 * F * stress + q * w.transpose()) * gradient + F * w * corner_patterns().transpose();
  }
};

/// State of a cell.
struct Stretched : Placed, StrainOfC {
  Numbers y;

  Stretched(const CellShape& shape, const Corners& x, StrainOfCell strain = StrainOfCell::logarithmic)
      : Placed(shape, x), StrainOfC(strain, C()), y(deformations(value)) {}

  /// S, of the log strain, in axes of the eigenvectors, from M y.
  Eigen::Matrix3d stress(const Numbers& of) const { return in_axes(edge * of.head<6>()); }
  /// Its product with the derivative of the log strain to C = F^T F.
  Eigen::Matrix3d stress_of_C(const Numbers& of) const { return StrainOfC::stress_of_C(edge * of.head<6>()); }

  /// Derivative of C to F(i, j), in axes of the eigenvectors.
  Eigen::Matrix3d change_of_C(int i, int j) const {
    const Eigen::Vector3d row = V.transpose() * F.row(i).transpose(), axis = V.row(j).transpose();
    return axis * row.transpose() + row * axis.transpose();
  }

  /// dE/dx of the corners.
  Corners force(const Numbers& of) const { return Placed::force(stress_of_C(of), in_patterns(of)); }

  /// dy/dx, 3 * corner + axis.
  DeformationRows slope() const {
    DeformationRows Y = DeformationRows::Zero();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const Voigt strain = edge * strains_of(V * slopes.cwiseProduct(change_of_C(i, j)) * V.transpose());
        for (int n = 0; n < 8; ++n) {
          Y.block<6, 1>(0, 3 * n + i) += gradient(j, n) * strain;
          for (int m = 0; m < 4; ++m)
            Y(6 + 3 * m + j, 3 * n + i) = gradient(j, n) * q(i, m) + F(i, j) * corner_patterns()(n, m);
        }
      }
    return Y;
  }

  /// The product of M y with d2y/dx2.
  CellMatrix24 curvature(const Numbers& of) const {
    Eigen::Matrix<double, 9, 9> of_F = Eigen::Matrix<double, 9, 9>::Zero();
    const Eigen::Matrix3d A = 2 * stress_of_C(of), S = stress(of);
    Eigen::Matrix3d second[3];  // S(i, j) times the second divided differences at i, k, j
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) second[k](i, j) = S(i, j) * divided(c[i], c[k], c[j]);
    for (int a = 0; a < 9; ++a)
      for (int b = 0; b < 9; ++b) {
        if (a % 3 == b % 3) of_F(a, b) += A(a / 3, b / 3);
        const Eigen::Matrix3d H = change_of_C(a % 3, a / 3), G = change_of_C(b % 3, b / 3);
        for (int k = 0; k < 3; ++k)
          of_F(a, b) += H.col(k).dot(second[k] * G.col(k)) + G.col(k).dot(second[k] * H.col(k));
      }
    const Eigen::Matrix<double, 9, 24> B = slope_of_gradient(gradient);
    CellMatrix24 K = B.transpose() * of_F * B;
    const Eigen::Matrix<double, 8, 8> turned = corner_patterns() * in_patterns(of).transpose() * gradient;
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b)
        for (int i = 0; i < 3; ++i) K(3 * a + i, 3 * b + i) += turned(a, b) + turned(b, a);
    return K;
  }
};

/// dE/dC of stresses s over a step: the mean at the Gauss points of the line from C0 to C1, corrected along it to the
/// work s . (e1 - e0) where what it lacks is more than round-off.
Eigen::Matrix3d mean_stress_of_C(const StrainOfC& at0, const StrainOfC& at1, const Eigen::Matrix3d& C0,
                                 const Eigen::Matrix3d& C1, const Voigt& s) {
  if (at0.measure == StrainOfCell::green_lagrange) return at0.stress_of_C(s);
  constexpr double small_change = 1e-5;  // as of EnergyMomentum
  const Eigen::Matrix3d change = C1 - C0, middle = (C0 + C1) / 2, off = 0.5 / std::sqrt(3.0) * change;
  const Eigen::Matrix3d mean =
      (StrainOfC(at0.measure, middle - off).stress_of_C(s) + StrainOfC(at0.measure, middle + off).stress_of_C(s)) / 2;
  const double size = change.squaredNorm();
  if (size < small_change) return mean;
  return mean + (s.dot(at1.value - at0.value) - mean.cwiseProduct(change).sum()) / size * change;
}

}  // namespace

DeformationRows deformation_of(const CellShape& cell) {
  DeformationRows T = DeformationRows::Zero();
  const std::array<Vec3, 8> g = mean_gradients(cell);
  for (int n = 0; n < 8; ++n)
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      T(i, 3 * n + i) = cell.edge * g[n][i];
      T(3 + i, 3 * n + j) = cell.edge * g[n][k];
      T(3 + i, 3 * n + k) = cell.edge * g[n][j];
      for (int m = 0; m < 4; ++m) T(6 + 3 * m + i, 3 * n + i) = corner_patterns()(n, m);
    }
  return T;
}

Deformations deformations(StrainOfCell strain, const CellAt& cell, const NodalVectors& x) {
  return Stretched(cell.shape, corners_at(cell.corners, x), strain).y;
}

void add_forces_of(StrainOfCell strain, const Deformations& s, const CellAt& cell, const NodalVectors& x,
                   NodalVectors& f) {
  subtract(Stretched(cell.shape, corners_at(cell.corners, x), strain).force(s), cell.corners, f);
}

void add_mean_forces_of(StrainOfCell strain, const Deformations& s, const CellAt& cell, const NodalVectors& x0,
                        const NodalVectors& x1, NodalVectors& f) {
  const Corners p0 = corners_at(cell.corners, x0), p1 = corners_at(cell.corners, x1);
  const Stretched at0(cell.shape, p0, strain), at1(cell.shape, p1, strain);
  const Placed middle(cell.shape, (p0 + p1) / 2);
  const Eigen::Matrix3d stress = mean_stress_of_C(at0, at1, at0.C(), at1.C(), middle.edge * s.head<6>());
  subtract(middle.force(stress, Placed::in_patterns(s)), cell.corners, f);
}

DeformationForm without_volume(const DeformationForm& M) {
  DeformationForm P = DeformationForm::Identity();
  P.topLeftCorner<3, 3>().array() -= 1.0 / 3;
  return P * M * P;
}

DeformationForm form_of(const AveragedSprings& law, const CellShape& cell) {
  DeformationForm M = DeformationForm::Zero();
  const double unit = cell.volume() / (cell.edge * cell.edge);
  M.topLeftCorner<3, 3>().setConstant(unit * law.lame_lambda);
  for (int i = 0; i < 3; ++i) {
    M(i, i) += 2 * unit * law.shear_modulus;
    M(3 + i, 3 + i) = unit * law.shear_modulus;
  }
  M.bottomRightCorner<12, 12>() = cell_form(law, cell).hourglass;
  return M;
}

AveragedSprings mean_springs(const MeasuredCells& law, const CellSet& cells) {
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  double volume = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const CellShape cell = cells.shape(c);
    sum += cell.edge * cell.edge * law.form_of_cell(c).topLeftCorner<6, 6>();
    volume += cell.volume();
  }
  const double on_axes = sum.topLeftCorner<3, 3>().trace(), all = sum.topLeftCorner<3, 3>().sum(),
               shears = sum.bottomRightCorner<3, 3>().trace();
  AveragedSprings springs;
  springs.shear_modulus = ((3 * on_axes - all) / 6 + shears) / (5 * volume);
  springs.lame_lambda = all / (9 * volume) - 2 * springs.shear_modulus / 3;
  const double nu = springs.lame_lambda / (2 * (springs.lame_lambda + springs.shear_modulus));
  springs.hourglass = HourglassStiffness::of_pattern(2, nu, true, true);
  return springs;
}

const char* MeasuredCells::lacks(Capability what) const {
  return what == Capability::equal_cells ? "differ from cell to cell" : nullptr;
}

DeformationForm MeasuredCells::form_of_cell(std::size_t cell) const {
  const double* number = form.data() + numbers_of_form * cell;
  DeformationForm M;
  for (int i = 0; i < deformations_of_cell; ++i)
    for (int j = 0; j <= i; ++j) M(i, j) = M(j, i) = *number++;
  return M;
}

void MeasuredCells::add_form(const DeformationForm& M) {
  for (int i = 0; i < deformations_of_cell; ++i)
    for (int j = 0; j <= i; ++j) form.push_back(M(i, j));
}

Eigen::Matrix<double, 24, 24> MeasuredCells::cell_matrix(const CellSet& cells, std::size_t cell) const {
  const DeformationRows T = deformation_of(cells.shape(cell));
  return T.transpose() * form_of_cell(cell) * T;
}

double MeasuredCells::energy(const Network& network, const NodalVectors& x) const {
  double sum = 0;
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const Stretched cell(network.cells.shape(c), corners_at(network.cells.corners[c], x));
    if (cell.inverted()) return std::numeric_limits<double>::infinity();
    sum += cell.y.dot(form_of_cell(c) * cell.y) / 2;
  }
  return sum;
}

void MeasuredCells::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const Hexahedron& corners = network.cells.corners[c];
    const Stretched cell(network.cells.shape(c), corners_at(corners, x));
    Corners force = cell.force(form_of_cell(c) * cell.y);
    if (cell.inverted()) force.setConstant(std::numeric_limits<double>::quiet_NaN());
    subtract(force, corners, f);
  }
}

void MeasuredCells::add_viscous_forces(const Network& network, const NodalVectors& x, const NodalVectors& v,
                                       double time, NodalVectors& f) const {
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const Hexahedron& corners = network.cells.corners[c];
    const Stretched cell(network.cells.shape(c), corners_at(corners, x));
    const Corners rate = corners_at(corners, v);
    const Numbers y_rate = cell.slope() * Eigen::Map<const Eigen::Matrix<double, 24, 1>>(rate.data());
    subtract(cell.force(time * (form_of_cell(c) * y_rate)), corners, f);
  }
}

void MeasuredCells::add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const {
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const Hexahedron& corners = network.cells.corners[c];
    const Stretched cell(network.cells.shape(c), corners_at(corners, x));
    const DeformationForm M = form_of_cell(c);
    const DeformationRows Y = cell.slope();
    add_cell(Y.transpose() * M * Y + cell.curvature(M * cell.y), corners, K);
  }
}

}  // namespace springproof
