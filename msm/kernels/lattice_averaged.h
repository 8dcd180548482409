// Averaged springs of a row of cells.  For the lattice kernels only.
#pragma once

#include "msm/kernels/lattice_rows.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

/// ln J, given y = J^(-1/3).
template <class Real>
SPRINGPROOF_INLINE Lanes<Real> logarithm(const Lanes<Real>& J, const Lanes<Real>& y) {
  // ln J = -3 ln y = -6 artanh z
  const Lanes<Real> z = (y - Real(1)) / (y + Real(1)), s = z * z;
  if (stdx::all_of(s < Real(0.0135))) {
    constexpr int terms = sizeof(Real) == 8 ? 8 : 4;
    Lanes<Real> sum = Real(1.0 / (2 * terms + 1));
    for (int k = terms - 1; k >= 0; --k) sum = Real(1.0 / (2 * k + 1)) + s * sum;
    return Real(-6) * z * sum;
  }
  Real values[lanes<Real>];
  store(J, values);
  for (Real& value : values) value = static_cast<Real>(__builtin_log(static_cast<double>(value)));
  return load(values);
}

/// dW/dF times edge^2 [N] of a cell, W as StrainCurve says.
template <LatticeCurve curve, class Real>
SPRINGPROOF_INLINE void stress_of(const LatticeAveraged<Real>& law, const Lanes<Real> (&F)[3][3],
                                  Lanes<Real> (&P)[3][3]) {
  using V = Lanes<Real>;
  V cofactor[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactor[i][j] = F[i1][j1] * F[i2][j2] - F[i1][j2] * F[i2][j1];
    }
  const V J = F[0][0] * cofactor[0][0] + F[0][1] * cofactor[0][1] + F[0][2] * cofactor[0][2];
  const V y = inverse_cube_root(J), m = y * y, inverse = m * y;
  const auto set = [&](const V& of_F, const V& of_inverse_transpose) {
    const V c = of_inverse_transpose * inverse;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) P[i][j] = of_F * F[i][j] + c * cofactor[i][j];
  };
  if constexpr (curve == LatticeCurve::neo_hooke) {
    set(V(law.shear), law.lambda * logarithm(J, y) - law.shear);
    return;
  }
  V C[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) C[j][i] = C[i][j] = F[0][i] * F[0][j] + F[1][i] * F[1][j] + F[2][i] * F[2][j];
  const V lengths = C[0][0] + C[1][1] + C[2][2];
  if constexpr (curve == LatticeCurve::neo_hooke_isochoric) {
    const V scaled = law.shear * m;
    set(scaled, law.bulk * (J - Real(1)) * J - scaled * lengths * Real(1.0 / 3));
    return;
  }
  V areas = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    areas += C[i][i] * C[j][j] - C[i][j] * C[i][j];
  }
  const V n = m * m, measure = Real(0.25) * (m * lengths + n * areas - Real(6));
  const V slope = (Real(0.5) * law.shear) * (Real(1) + measure * (Real(-1.0 / 3) + measure * Real(2.0 / 15)));
  set(slope * (m + n * lengths),
      law.bulk * logarithm(J, y) - slope * (Real(1.0 / 3) * m * lengths + Real(2.0 / 3) * n * areas));
  const V turned = slope * n;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) P[i][j] -= turned * (F[i][0] * C[0][j] + F[i][1] * C[1][j] + F[i][2] * C[2][j]);
}

/// Forces of the cells between four rows, which have (y, z) offsets 00, 10, 01, 11 from the first; formulas:
/// AveragedSprings::add_forces() of a full cell, in sums over the corners instead of their means.
template <LatticeCurve curve, class Real>
void averaged_of_cells(const Row<Real> (&r)[4], const ForceRow<Real> (&on)[4], const Coefficients<Real>& c,
                       const LatticeAveraged<Real>& law, int begin, int end) {
  using V = Lanes<Real>;
  const Real* const at[3][4] = {
      {r[0].x, r[1].x, r[2].x, r[3].x}, {r[0].y, r[1].y, r[2].y, r[3].y}, {r[0].z, r[1].z, r[2].z, r[3].z}};
  Real* const force[3][4] = {
      {on[0].x, on[1].x, on[2].x, on[3].x}, {on[0].y, on[1].y, on[2].y, on[3].y}, {on[0].z, on[1].z, on[2].z, on[3].z}};
  V before[3][4];
  for (auto& component : before)
    for (V& row : component) row = 0;
  for (int b = begin; b < end; ++b) {
    const long n = long(b) * lanes<Real>;
    V F[3][3], S[3][4];  // S: patterns yz, zx, xy, xyz
    for (int i = 0; i < 3; ++i) {
      V d[4], m[4];
      for (int k = 0; k < 4; ++k) {
        const V low = load(at[i][k] + n), high = load(at[i][k] + n + 1);
        d[k] = high - low;
        m[k] = high + low;
      }
      const V d01 = d[1] - d[0], d23 = d[3] - d[2], m01 = m[1] - m[0], m23 = m[3] - m[2];
      F[i][0] = Real(0.25) * ((d[0] + d[1]) + (d[2] + d[3]));
      F[i][1] = Real(0.25) * (m01 + m23);
      F[i][2] = Real(0.25) * ((m[2] - m[0]) + (m[3] - m[1]));
      F[i][i] += Real(1);
      S[i][0] = m23 - m01;
      S[i][1] = (d[2] - d[0]) + (d[3] - d[1]);
      S[i][2] = d01 + d23;
      S[i][3] = d23 - d01;
    }
    const auto absent = coefficient(c.of(b), hourglass_coefficient) == Real(0);
    if (stdx::any_of(absent))
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) stdx::where(absent, F[i][j]) = i == j ? Real(1) : Real(0);
        for (V& s : S[i]) stdx::where(absent, s) = Real(0);
      }
    V v[4][3], w[4][3];
    for (int m = 0; m < 4; ++m)
      for (int j = 0; j < 3; ++j) v[m][j] = F[0][j] * S[0][m] + F[1][j] * S[1][m] + F[2][j] * S[2][m];
    const V twisted = law.torsion * (v[0][0] + v[1][1] + v[2][2]);
    for (int m = 0; m < 3; ++m) {
      for (int j = 0; j < 3; ++j)
        w[m][j] =
            m == j ? (law.torsion + law.twist) * v[m][m] + twisted : law.bending * v[m][j] + law.coupling * v[j][m];
      w[3][m] = law.warping * v[3][m];
    }
    V P[3][3];
    stress_of<curve>(law, F, P);
    for (int i = 0; i < 3; ++i) {
      V A[3], B[4];
      for (int j = 0; j < 3; ++j)
        A[j] =
            Real(0.25) * (P[i][j] + (S[i][0] * w[0][j] + S[i][1] * w[1][j]) + (S[i][2] * w[2][j] + S[i][3] * w[3][j]));
      for (int m = 0; m < 4; ++m) B[m] = F[i][0] * w[m][0] + F[i][1] * w[m][1] + F[i][2] * w[m][2];
      // Minus the force on a corner with signs (x, y, z): x A0 + y A1 + z A2 + yz B0 + zx B1 + xy B2 + xyz B3.
      const V even[4] = {B[0] - A[1] - A[2], A[1] - A[2] - B[0], A[2] - A[1] - B[0], A[1] + A[2] + B[0]};
      const V near = A[0] - B[1], far = A[0] + B[1], minus = B[2] - B[3], plus = B[2] + B[3];
      const V odd[4] = {near - minus, near + minus, far - plus, far + plus};
      for (int k = 0; k < 4; ++k) {
        const V high = even[k] + odd[k];
        store<Real>(load(force[i][k] + n) - ((even[k] - odd[k]) + shift_in(before[i][k], high)), force[i][k] + n);
        before[i][k] = high;
      }
    }
  }
}

template <class Real>
void averaged_of_cells(const Row<Real> (&r)[4], const ForceRow<Real> (&on)[4], const Coefficients<Real>& c,
                       const LatticeAveraged<Real>& law, int begin, int end) {
  switch (law.curve) {
    case LatticeCurve::hencky:
      return averaged_of_cells<LatticeCurve::hencky>(r, on, c, law, begin, end);
    case LatticeCurve::neo_hooke:
      return averaged_of_cells<LatticeCurve::neo_hooke>(r, on, c, law, begin, end);
    case LatticeCurve::neo_hooke_isochoric:
      return averaged_of_cells<LatticeCurve::neo_hooke_isochoric>(r, on, c, law, begin, end);
    case LatticeCurve::none:
      return;
  }
}

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
