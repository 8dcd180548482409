// Averaged springs of a row of cells.  For the lattice kernels only.
#pragma once

#include "msm/kernels/lattice_rows.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

/// 2 artanh z, for z^2 < 0.0135.
template <class Real>
SPRINGPROOF_INLINE Lanes<Real> twice_artanh(const Lanes<Real>& z) {
  constexpr int terms = sizeof(Real) == 8 ? 8 : 4;
  const Lanes<Real> s = z * z;
  Lanes<Real> sum = Real(1.0 / (2 * terms + 1));
  for (int k = terms - 1; k >= 0; --k) sum = Real(1.0 / (2 * k + 1)) + s * sum;
  return Real(2) * z * sum;
}

/// ln(1 + d), to the relative accuracy of d.
template <class Real>
SPRINGPROOF_INLINE Lanes<Real> logarithm_of_1_and(const Lanes<Real>& d) {
  const Lanes<Real> z = d / (d + Real(2));
  if (stdx::all_of(z * z < Real(0.0135))) return twice_artanh(z);
  const Lanes<Real> y = inverse_cube_root(d + Real(1)), far = (Real(1) - y) / (Real(1) + y);
  if (stdx::all_of(far * far < Real(0.0135))) return Real(3) * twice_artanh(far);
  Real values[lanes<Real>];
  store(d, values);
  for (Real& value : values) value = static_cast<Real>(__builtin_log1p(static_cast<double>(value)));
  return load(values);
}

/// Stress tau of the law times edge^2 [N], of F = 1 + D: dW/dF = tau F^-T.  In terms of b = F F^T - 1 and J - 1, so
/// that the error is one of the strain, not of 1.
template <LatticeCurve curve, class Real>
SPRINGPROOF_INLINE void kirchhoff_stress(const LatticeAveraged<Real>& law, const Lanes<Real> (&D)[3][3],
                                         const Lanes<Real>& dilatation, Lanes<Real> (&tau)[3][3]) {
  using V = Lanes<Real>;
  V b[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      b[i][j] = b[j][i] = D[i][j] + D[j][i] + (D[i][0] * D[j][0] + D[i][1] * D[j][1] + D[i][2] * D[j][2]);
  const V trace = b[0][0] + b[1][1] + b[2][2];
  if constexpr (curve == LatticeCurve::neo_hooke) {
    const V volume = law.lambda * logarithm_of_1_and(dilatation);
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) tau[i][j] = tau[j][i] = law.shear * b[i][j] + (i == j ? volume : V(0));
    return;
  }
  const V J = dilatation + Real(1), y = inverse_cube_root(J), m = y * y;
  if constexpr (curve == LatticeCurve::neo_hooke_isochoric) {
    const V scaled = law.shear * m, volume = law.bulk * dilatation * J - scaled * trace * Real(1.0 / 3);
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) tau[i][j] = tau[j][i] = scaled * b[i][j] + (i == j ? volume : V(0));
    return;
  }
  // Hencky: G f'(y) / 2 times the deviator of m B + n (tr B B - B^2) = (m + n (1 + tr b)) b - n b^2 + ...
  V square[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) square[i][j] = b[i][0] * b[j][0] + b[i][1] * b[j][1] + b[i][2] * b[j][2];
  const V of_square = square[0][0] + square[1][1] + square[2][2], n = m * m;
  const V lengths = Real(3) + trace, areas = Real(3) + Real(2) * trace + Real(0.5) * (trace * trace - of_square);
  const V measure = Real(0.25) * (m * lengths + n * areas - Real(6));
  const V slope = (Real(0.5) * law.shear) * (Real(1) + measure * (Real(-1.0 / 3) + measure * Real(2.0 / 15)));
  const V first = slope * (m + n * (Real(1) + trace)), second = slope * n;
  const V volume = law.bulk * logarithm_of_1_and(dilatation) - Real(1.0 / 3) * (first * trace - second * of_square);
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      tau[i][j] = tau[j][i] = first * b[i][j] - second * square[i][j] + (i == j ? volume : V(0));
}

/// D = F - 1 and the patterns S (yz, zx, xy, xyz) of a block of cells, from displacements; of velocities their rates.
/// Zero where there is no cell.
template <class Real>
SPRINGPROOF_INLINE void patterns_of_cells(const Row<Real> (&r)[4], long n, const Lanes<Real>& present,
                                          Lanes<Real> (&D)[3][3], Lanes<Real> (&S)[3][4]) {
  using V = Lanes<Real>;
  const Real* const at[3][4] = {
      {r[0].x, r[1].x, r[2].x, r[3].x}, {r[0].y, r[1].y, r[2].y, r[3].y}, {r[0].z, r[1].z, r[2].z, r[3].z}};
  for (int i = 0; i < 3; ++i) {
    V d[4], m[4];
    for (int k = 0; k < 4; ++k) {
      const V low = load(at[i][k] + n), high = load(at[i][k] + n + 1);
      d[k] = high - low;
      m[k] = high + low;
    }
    const V d01 = d[1] - d[0], d23 = d[3] - d[2], m01 = m[1] - m[0], m23 = m[3] - m[2];
    D[i][0] = Real(0.25) * ((d[0] + d[1]) + (d[2] + d[3]));
    D[i][1] = Real(0.25) * (m01 + m23);
    D[i][2] = Real(0.25) * ((m[2] - m[0]) + (m[3] - m[1]));
    S[i][0] = m23 - m01;
    S[i][1] = (d[2] - d[0]) + (d[3] - d[1]);
    S[i][2] = d01 + d23;
    S[i][3] = d23 - d01;
  }
  const auto absent = present == Real(0);
  if (stdx::any_of(absent))
    for (int i = 0; i < 3; ++i) {
      for (V& entry : D[i]) stdx::where(absent, entry) = Real(0);
      for (V& s : S[i]) stdx::where(absent, s) = Real(0);
    }
}

/// w += (hourglass springs) v; constants in the three directions of a pattern.
template <class Real>
SPRINGPROOF_INLINE void add_hourglass_forces(const LatticeAveraged<Real>& law, const Lanes<Real> (&v)[4][3],
                                             Lanes<Real> (&w)[4][3]) {
  const Lanes<Real> twisted = law.torsion * (v[0][0] + v[1][1] + v[2][2]);
  for (int m = 0; m < 3; ++m) {
    for (int j = 0; j < 3; ++j)
      w[m][j] +=
          m == j ? (law.torsion + law.twist) * v[m][m] + twisted : law.bending * v[m][j] + law.coupling * v[j][m];
    w[3][m] += law.warping * v[3][m];
  }
}

/// F^-T and J - 1, F = 1 + D.
template <class Real>
SPRINGPROOF_INLINE void invert(const Lanes<Real> (&D)[3][3], const Lanes<Real> (&F)[3][3],
                               Lanes<Real> (&inverse_transposed)[3][3], Lanes<Real>& dilatation) {
  using V = Lanes<Real>;
  const auto minor = [](const V(&A)[3][3], int i, int j) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return A[i1][j1] * A[i2][j2] - A[i1][j2] * A[i2][j1];
  };
  const V m00 = minor(D, 0, 0);
  dilatation = (D[0][0] + D[1][1] + D[2][2]) + (m00 + minor(D, 1, 1) + minor(D, 2, 2)) +
               (D[0][0] * m00 + D[0][1] * minor(D, 0, 1) + D[0][2] * minor(D, 0, 2));
  const V inverse = Real(1) / (dilatation + Real(1));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) inverse_transposed[i][j] = inverse * minor(F, i, j);
}

/// P += G F 2E' + lambda tr(F' F^-1) F^-T and v = F'^T S + F^T S': viscous stress and rates of the hourglass
/// components (AveragedSprings::add_viscous_forces()).
template <class Real>
SPRINGPROOF_INLINE void add_viscous_stress(const LatticeAveraged<Real>& dashpots, const Lanes<Real> (&F)[3][3],
                                           const Lanes<Real> (&inverse_transposed)[3][3], const Lanes<Real> (&S)[3][4],
                                           const Lanes<Real> (&rate)[3][3], const Lanes<Real> (&S_rate)[3][4],
                                           Lanes<Real> (&P)[3][3], Lanes<Real> (&v)[4][3]) {
  using V = Lanes<Real>;
  V twice[3][3];
  for (int j = 0; j < 3; ++j)
    for (int k = j; k < 3; ++k)
      twice[j][k] = twice[k][j] = (F[0][j] * rate[0][k] + F[1][j] * rate[1][k] + F[2][j] * rate[2][k]) +
                                  (rate[0][j] * F[0][k] + rate[1][j] * F[1][k] + rate[2][j] * F[2][k]);
  V trace = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) trace += rate[i][j] * inverse_transposed[i][j];
  const V volume = dashpots.lambda * trace;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P[i][j] += dashpots.shear * (F[i][0] * twice[0][j] + F[i][1] * twice[1][j] + F[i][2] * twice[2][j]) +
                 volume * inverse_transposed[i][j];
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j)
      v[m][j] = (rate[0][j] * S[0][m] + rate[1][j] * S[1][m] + rate[2][j] * S[2][m]) +
                (F[0][j] * S_rate[0][m] + F[1][j] * S_rate[1][m] + F[2][j] * S_rate[2][m]);
}

/// Forces of the cells between four rows, which have (y, z) offsets 00, 10, 01, 11 from the first; formulas:
/// AveragedSprings::add_forces() of a full cell, in sums over the corners instead of their means.  No curve: the
/// dashpots alone.
template <LatticeCurve curve, bool viscous, class Real>
void averaged_of_cells(const Row<Real> (&r)[4], const Row<Real> (&moving)[4], const ForceRow<Real> (&on)[4],
                       const Coefficients<Real>& c, const LatticeView<Real>& l, int begin, int end) {
  using V = Lanes<Real>;
  Real* const force[3][4] = {
      {on[0].x, on[1].x, on[2].x, on[3].x}, {on[0].y, on[1].y, on[2].y, on[3].y}, {on[0].z, on[1].z, on[2].z, on[3].z}};
  V before[3][4];
  for (auto& component : before)
    for (V& row : component) row = 0;
  for (int b = begin; b < end; ++b) {
    const long n = long(b) * lanes<Real>;
    const V present = coefficient(c.of(b), hourglass_coefficient);
    V D[3][3], S[3][4], F[3][3], inverse_transposed[3][3], dilatation, P[3][3], v[4][3], w[4][3];
    patterns_of_cells(r, n, present, D, S);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) F[i][j] = i == j ? D[i][j] + Real(1) : D[i][j];
    invert(D, F, inverse_transposed, dilatation);
    for (auto& of_pattern : w)
      for (V& entry : of_pattern) entry = 0;
    if constexpr (curve == LatticeCurve::none) {
      for (auto& row : P)
        for (V& entry : row) entry = 0;
    } else {
      for (int m = 0; m < 4; ++m)
        for (int j = 0; j < 3; ++j) v[m][j] = F[0][j] * S[0][m] + F[1][j] * S[1][m] + F[2][j] * S[2][m];
      add_hourglass_forces(l.averaged, v, w);
      V tau[3][3];
      kirchhoff_stress<curve>(l.averaged, D, dilatation, tau);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          P[i][j] = tau[i][0] * inverse_transposed[0][j] + tau[i][1] * inverse_transposed[1][j] +
                    tau[i][2] * inverse_transposed[2][j];
    }
    if constexpr (viscous) {
      V rate[3][3], S_rate[3][4];
      patterns_of_cells(moving, n, present, rate, S_rate);
      add_viscous_stress(l.dashpots, F, inverse_transposed, S, rate, S_rate, P, v);
      add_hourglass_forces(l.dashpots, v, w);
    }
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

/// Of the view's curve; `moving`: the rows of velocities.
template <bool viscous, class Real>
void averaged_of_cells(const Row<Real> (&r)[4], const Row<Real> (&moving)[4], const ForceRow<Real> (&on)[4],
                       const Coefficients<Real>& c, const LatticeView<Real>& l, int begin, int end) {
  switch (l.averaged.curve) {
    case LatticeCurve::hencky:
      return averaged_of_cells<LatticeCurve::hencky, viscous>(r, moving, on, c, l, begin, end);
    case LatticeCurve::neo_hooke:
      return averaged_of_cells<LatticeCurve::neo_hooke, viscous>(r, moving, on, c, l, begin, end);
    case LatticeCurve::neo_hooke_isochoric:
      return averaged_of_cells<LatticeCurve::neo_hooke_isochoric, viscous>(r, moving, on, c, l, begin, end);
    case LatticeCurve::none:
      if constexpr (viscous) averaged_of_cells<LatticeCurve::none, true>(r, moving, on, c, l, begin, end);
  }
}

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
