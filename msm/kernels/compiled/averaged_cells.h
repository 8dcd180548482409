// Averaged springs of a vector of cells: patterns of their corners, stress and forces.  What the kernels of lattices
// and those of lists of cells share.
#pragma once

#include "msm/kernels/compiled/simd_math.h"
#include "msm/kernels/lattice_kernels.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

/// Sums of the values at the corners of a cell, with signs: x, y, z into `along`; yz, zx, xy, xyz into `S`.
/// d: differences along x, of the edges with (y, z) = 00, 10, 01, 11; m: sums.
template <class Real>
SPRINGPROOF_INLINE void signed_sums(const Lanes<Real> (&d)[4], const Lanes<Real> (&m)[4], Lanes<Real> (&along)[3],
                                    Lanes<Real> (&S)[4]) {
  const Lanes<Real> d01 = d[1] - d[0], d23 = d[3] - d[2], m01 = m[1] - m[0], m23 = m[3] - m[2];
  along[0] = (d[0] + d[1]) + (d[2] + d[3]);
  along[1] = m01 + m23;
  along[2] = (m[2] - m[0]) + (m[3] - m[1]);
  S[0] = m23 - m01;
  S[1] = (d[2] - d[0]) + (d[3] - d[1]);
  S[2] = d01 + d23;
  S[3] = d23 - d01;
}

/// The transpose: x A0 + y A1 + z A2 + yz B0 + zx B1 + xy B2 + xyz B3 at the corners, `even` - `odd` at the near end of
/// an edge along x and `even` + `odd` at its far one.
template <class Real>
SPRINGPROOF_INLINE void at_corners(const Lanes<Real> (&A)[3], const Lanes<Real> (&B)[4], Lanes<Real> (&even)[4],
                                   Lanes<Real> (&odd)[4]) {
  const Lanes<Real> near = A[0] - B[1], far = A[0] + B[1], minus = B[2] - B[3], plus = B[2] + B[3];
  even[0] = B[0] - A[1] - A[2];
  even[1] = A[1] - A[2] - B[0];
  even[2] = A[2] - A[1] - B[0];
  even[3] = A[1] + A[2] + B[0];
  odd[0] = near - minus;
  odd[1] = near + minus;
  odd[2] = far - plus;
  odd[3] = far + plus;
}

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
  return plain_logarithm_of_1_and(d);
}

/// Stress tau of the law in the units of its moduli, of F = 1 + D: dW/dF = tau F^-T.  In terms of b = F F^T - 1 and
/// J - 1, so that the error is one of the strain, not of 1.  Moduli: of all cells, or one per lane.
template <LatticeCurve curve, class Real, class Modulus>
SPRINGPROOF_INLINE void kirchhoff_stress(const LatticeAveraged<Modulus>& law, const Lanes<Real> (&D)[3][3],
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

/// P = tau F^-T, the stress dW/dF of the law in the units of its moduli.
template <LatticeCurve curve, class Real, class Modulus>
SPRINGPROOF_INLINE void first_stress(const LatticeAveraged<Modulus>& law, const Lanes<Real> (&D)[3][3],
                                     const Lanes<Real> (&inverse_transposed)[3][3], const Lanes<Real>& dilatation,
                                     Lanes<Real> (&P)[3][3]) {
  Lanes<Real> tau[3][3];
  kirchhoff_stress<curve, Real>(law, D, dilatation, tau);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P[i][j] = tau[i][0] * inverse_transposed[0][j] + tau[i][1] * inverse_transposed[1][j] +
                tau[i][2] * inverse_transposed[2][j];
}

/// v = F^T S.
template <class Real>
SPRINGPROOF_INLINE void turned_back(const Lanes<Real> (&F)[3][3], const Lanes<Real> (&S)[3][4],
                                    Lanes<Real> (&v)[4][3]) {
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j) v[m][j] = F[0][j] * S[0][m] + F[1][j] * S[1][m] + F[2][j] * S[2][m];
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

/// The rate of v = F^T S, of those of F and S.
template <class Real>
SPRINGPROOF_INLINE void turned_back_rates(const Lanes<Real> (&F)[3][3], const Lanes<Real> (&S)[3][4],
                                          const Lanes<Real> (&rate)[3][3], const Lanes<Real> (&S_rate)[3][4],
                                          Lanes<Real> (&v)[4][3]) {
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j)
      v[m][j] = (rate[0][j] * S[0][m] + rate[1][j] * S[1][m] + rate[2][j] * S[2][m]) +
                (F[0][j] * S_rate[0][m] + F[1][j] * S_rate[1][m] + F[2][j] * S_rate[2][m]);
}

/// P += G F 2E' + lambda tr(F' F^-1) F^-T: the viscous stress (AveragedSprings::add_viscous_forces()).
template <class Real, class Modulus>
SPRINGPROOF_INLINE void add_viscous_stress(const LatticeAveraged<Modulus>& dashpots, const Lanes<Real> (&F)[3][3],
                                           const Lanes<Real> (&inverse_transposed)[3][3],
                                           const Lanes<Real> (&rate)[3][3], Lanes<Real> (&P)[3][3]) {
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
}

/// Pressure, per kappa, of cells with volume ratio J; arbitrary where there is no cell.
template <bool bounded, class Real>
SPRINGPROOF_INLINE Lanes<Real> pressure(Lanes<Real> J, const Lanes<Real>& kappa) {
  if constexpr (bounded) {
    stdx::where(kappa == Real(0), J) = 1;
    const Lanes<Real> d = J - Real(1);
    // 3 (J^(1/3) - 1) / J^(2/3); near 1 a series gives a start value that needs only one step.
    Lanes<Real> y;
    if (stdx::all_of(stdx::abs(d) < Real(0.125)))
      y = nearer_inverse_cube_root(J, Real(1) - d * (Real(1.0 / 3) - d * (Real(2.0 / 9) - d * Real(14.0 / 81))));
    else
      y = inverse_cube_root(J);
    return Real(3) * y * (Real(1) - y);
  } else {
    return J - Real(1);
  }
}

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
