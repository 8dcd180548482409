#include "msm/laws/strain_energy.h"

#include <Eigen/LU>
#include <cmath>

namespace springproof {
namespace {

using Mat3 = Eigen::Matrix3d;
using Vector9 = Eigen::Matrix<double, 9, 1>;

Vector9 vec(const Mat3& A) { return Eigen::Map<const Vector9>(A.data()); }

/// f, df/dF and d2f/dF2 of a scalar function of F.
struct Scalar {
  double value;
  Vector9 first;
  Matrix9 second;
};

/// Quantities of F that every energy is made of.
class Strain {
 public:
  Strain(const Mat3& gradient, Derivative up_to) : F(gradient), J(gradient.determinant()), up_to_(up_to) {
    if (up_to == Derivative::none) return;
    inverse_ = F.inverse();
    H = vec(inverse_.transpose());
    if (up_to != Derivative::second) return;
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          for (int i = 0; i < 3; ++i) T(j + 3 * k, l + 3 * i) = inverse_(i, j) * inverse_(k, l);
  }

  bool first() const { return up_to_ != Derivative::none; }
  bool second() const { return up_to_ == Derivative::second; }

  /// J^power
  Scalar power_of_J(double power) const {
    Scalar s{std::pow(J, power), {}, {}};
    if (first()) s.first = power * s.value * H;
    if (second()) s.second = power * s.value * (power * H * H.transpose() - T);
    return s;
  }

  /// tr C, the sum of the squared lengths of the edges
  Scalar lengths() const {
    Scalar s{F.squaredNorm(), {}, {}};
    if (first()) s.first = 2 * vec(F);
    if (second()) s.second = 2 * Matrix9::Identity();
    return s;
  }

  /// (tr^2 C - tr C^2) / 2, the sum of the squared areas of the faces
  Scalar areas() const {
    const Mat3 C = F.transpose() * F;
    const double I1 = C.trace();
    Scalar s{(I1 * I1 - C.squaredNorm()) / 2, {}, {}};
    if (first()) s.first = 2 * vec(I1 * F - F * C);
    if (!second()) return s;
    const Vector9 f = vec(F);
    const Mat3 B = F * F.transpose();
    s.second = 4 * f * f.transpose() + 2 * I1 * Matrix9::Identity();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) {
          s.second(i + 3 * j, i + 3 * k) -= 2 * C(k, j);
          s.second(i + 3 * j, k + 3 * j) -= 2 * B(i, k);
          for (int l = 0; l < 3; ++l) s.second(i + 3 * j, l + 3 * k) -= 2 * F(i, k) * F(l, j);
        }
    return s;
  }

  Scalar product(const Scalar& a, const Scalar& b) const {
    Scalar s{a.value * b.value, {}, {}};
    if (first()) s.first = a.value * b.first + b.value * a.first;
    if (second())
      s.second =
          a.value * b.second + b.value * a.second + a.first * b.first.transpose() + b.first * a.first.transpose();
    return s;
  }

  /// ln of the length of a unit vector's image over J^(1/3)
  Scalar log_stretch(const Eigen::Vector3d& n) const {
    const Eigen::Vector3d d = F * n;
    const double q = d.squaredNorm();
    Scalar s{std::log(q) / 2 - std::log(J) / 3, {}, {}};
    if (!first()) return s;
    const Vector9 along = vec(d * n.transpose()) / q;
    s.first = along - H / 3;
    if (!second()) return s;
    s.second = T / 3 - 2 * along * along.transpose();
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) s.second(i + 3 * j, i + 3 * k) += n[j] * n[k] / q;
    return s;
  }

  /// W += f(s), given f, f' and f''
  void add(double f, double slope, double curvature, const Scalar& s, StrainEnergy& W) const {
    W.value += f;
    if (first()) Eigen::Map<Vector9>(W.stress.data()) += slope * s.first;
    if (second()) W.tangent += slope * s.second + curvature * s.first * s.first.transpose();
  }

  void add_volume(StrainCurve curve, double factor, StrainEnergy& W) const {
    const VolumeDensity U = volume_term(curve, J);
    add(factor * U.value, factor * U.slope, factor * U.curvature, power_of_J(1), W);
  }

  const Mat3& F;
  const double J;
  Vector9 H;  ///< F^-T
  Matrix9 T;  ///< A, B -> tr(F^-1 A F^-1 B)

 private:
  Derivative up_to_;
  Mat3 inverse_;
};

/// Potential of a spring of logarithmic strain s: s^2/2 + p s^3/6 + r s^4/24.
struct SpringCurve {
  double p, r;
};
constexpr SpringCurve as_hencky{-4.17, -2.91}, as_neo_hooke{-0.83, -5.38};

void add_springs(const SpringCurve& c, double G, const Strain& strain, StrainEnergy& W) {
  for (const auto& [n, weight] : spring_directions()) {
    const Scalar s = strain.log_stretch(n);
    const double x = s.value, k = 15 * G * weight;
    strain.add(k * x * x * (1.0 / 2 + x * (c.p / 6 + x * c.r / 24)), k * x * (1 + x * (c.p / 2 + x * c.r / 6)),
               k * (1 + x * (c.p + x * c.r / 2)), s, W);
  }
}

/// G f(y), y = (J^(-2/3) tr C + J^(-4/3) areas - 6) / 4, which is Hencky's energy up to third order in y.
void add_lengths_and_areas(double G, const Strain& strain, StrainEnergy& W) {
  const Scalar lengths = strain.product(strain.power_of_J(-2.0 / 3), strain.lengths()),
               areas = strain.product(strain.power_of_J(-4.0 / 3), strain.areas());
  Scalar y{(lengths.value + areas.value - 6) / 4, {}, {}};
  if (strain.first()) y.first = (lengths.first + areas.first) / 4;
  if (strain.second()) y.second = (lengths.second + areas.second) / 4;
  const double v = y.value;
  strain.add(G * v * (1 + v * (-1.0 / 6 + v * 2 / 45)), G * (1 + v * (-1.0 / 3 + v * 2 / 15)),
             G * (-1.0 / 3 + v * 4 / 15), y, W);
}

}  // namespace

std::span<const SpringDirection> spring_directions() {
  static const std::array<SpringDirection, 13> all = [] {
    std::array<SpringDirection, 13> d;
    int next = 0;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          if (9 * x + 3 * y + z <= 0) continue;  // one of each pair of opposite directions
          const int length = x * x + y * y + z * z;
          d[next++] = {Eigen::Vector3d(x, y, z).normalized(), length == 1   ? 2.0 / 21
                                                              : length == 2 ? 8.0 / 105
                                                                            : 9.0 / 140};
        }
    return d;
  }();
  return all;
}

VolumeDensity volume_term(StrainCurve curve, double J) {
  if (curve == StrainCurve::neo_hooke_isochoric || curve == StrainCurve::springs_neo_hooke)
    return {0.5 * (J - 1) * (J - 1), J - 1, 1};
  const double e = std::log(J);
  return {0.5 * e * e, e / J, (1 - e) / (J * J)};
}

StrainEnergy springs_energy(StrainCurve curve, double G, const Mat3& F, Derivative up_to) {
  const Strain strain(F, up_to);
  StrainEnergy W;
  if (curve == StrainCurve::neo_hooke) {
    const Scalar lengths = strain.lengths(), J = strain.power_of_J(1);
    strain.add(G / 2 * (lengths.value - 3), G / 2, 0, lengths, W);
    strain.add(-G * std::log(J.value), -G / J.value, G / (J.value * J.value), J, W);
  }
  if (curve == StrainCurve::hencky) add_lengths_and_areas(G, strain, W);
  if (curve == StrainCurve::springs_hencky) add_springs(as_hencky, G, strain, W);
  if (curve == StrainCurve::springs_neo_hooke) add_springs(as_neo_hooke, G, strain, W);
  if (curve == StrainCurve::neo_hooke_isochoric) {
    const Scalar lengths = strain.product(strain.power_of_J(-2.0 / 3), strain.lengths());
    strain.add(G / 2 * (lengths.value - 3), G / 2, 0, lengths, W);
  }
  // Springs of rest length 0, those of neo_hooke, know the volume themselves.
  strain.add_volume(curve, curve == StrainCurve::neo_hooke ? G : 5 * G / 3, W);
  return W;
}

void add_volume_term(StrainCurve curve, double factor, const Mat3& F, Derivative up_to, StrainEnergy& W) {
  Strain(F, up_to).add_volume(curve, factor, W);
}

}  // namespace springproof
