// Measured cells of a vector of cells: their logarithmic strain, the product with their forms, stress.
#pragma once

#include "msm/kernels/compiled/averaged_cells.h"
#include "msm/kernels/list_kernels.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

/// E's eigenvalues on its diagonal, eigenvectors as the columns of Q, by Jacobi's rotations: four rounds leave less
/// than round-off.
template <class Real>
SPRINGPROOF_INLINE void find_eigenvectors(Lanes<Real> (&E)[3][3], Lanes<Real> (&Q)[3][3]) {
  using V = Lanes<Real>;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) Q[i][j] = i == j ? 1 : 0;
  for (int round = 0; round < 4; ++round)
    for (int p = 0; p < 3; ++p) {
      const int q = (p + 1) % 3, r = (p + 2) % 3;
      const V a = E[p][q], d = E[q][q] - E[p][p];
      V t = Real(2) * a / (stdx::abs(d) + stdx::sqrt(d * d + Real(4) * a * a) + Real(1e-30));
      stdx::where(d < Real(0), t) = -t;
      const V c = inverse_root<Real>(Real(1) + t * t), s = t * c, of_p = E[p][r], of_q = E[q][r];
      E[p][p] -= t * a;
      E[q][q] += t * a;
      E[p][q] = E[q][p] = 0;
      E[p][r] = E[r][p] = c * of_p - s * of_q;
      E[q][r] = E[r][q] = s * of_p + c * of_q;
      for (int k = 0; k < 3; ++k) {
        const V u = Q[k][p], v = Q[k][q];
        Q[k][p] = c * u - s * v;
        Q[k][q] = s * u + c * v;
      }
    }
}

/// ln(1 + t) / t.
template <class Real>
SPRINGPROOF_INLINE Lanes<Real> logarithm_over(const Lanes<Real>& t) {
  using V = Lanes<Real>;
  const V series =
      Real(1) - t * (Real(1.0 / 2) - t * (Real(1.0 / 3) - t * (Real(1.0 / 4) - t * (Real(1.0 / 5) - t / 6))));
  V ratio = logarithm_of_1_and<Real>(t) / t;
  stdx::where(t * t < Real(1e-6), ratio) = series;
  return ratio;
}

constexpr int strain_of[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {2, 0}, {0, 1}};

/// s = M y, M by its lower triangle, whose numbers are `stride` apart.
template <int stride, class Real>
SPRINGPROOF_INLINE void times_form(const Real* form, const Lanes<Real> (&y)[18], Lanes<Real> (&s)[18]) {
  for (int i = 0; i < 18; ++i) {
    Lanes<Real> sum = 0;
    for (int j = 0; j < i; ++j, form += stride) {
      const Lanes<Real> M = load(form);
      sum += M * y[j];
      s[j] += M * y[i];
    }
    s[i] = sum + load(form) * y[i];
    form += stride;
  }
}

/// The first three rows of M y together.
template <int stride, class Real>
SPRINGPROOF_INLINE Lanes<Real> trace_of_form(const Real* form, const Lanes<Real> (&y)[18]) {
  Lanes<Real> sum = 0;
  for (int i = 0; i < 18; ++i)
    for (int row = 0; row < 3; ++row) {
      const int low = i < row ? i : row, high = i < row ? row : i;
      sum += load(form + (high * (high + 1) / 2 + low) * stride) * y[i];
    }
  return sum;
}

/// y without the mean of its first three, which are z[0], z[1] and minus their sum: what branches follow.
template <class Real>
SPRINGPROOF_INLINE void shape_of(const Lanes<Real> (&y)[18], Lanes<Real> (&z)[overstrain_count]) {
  const Lanes<Real> mean = Real(1.0 / 3) * (y[0] + y[1] + y[2]);
  for (int e = 0; e < 2; ++e) z[e] = y[e] - mean;
  for (int e = 3; e < 18; ++e) z[e - 1] = y[e];
}
/// The y of shapes z.
template <class Real>
SPRINGPROOF_INLINE void deformations_of_shape(const Lanes<Real> (&z)[overstrain_count], Lanes<Real> (&y)[18]) {
  for (int e = 0; e < 2; ++e) y[e] = z[e];
  y[2] = -(z[0] + z[1]);
  for (int e = 3; e < 18; ++e) y[e] = z[e - 1];
}

/// How the cells of a vector are stretched: F^T F = 1 + sum E_k q_k q_k^T.
template <class Real>
struct Principal {
  Lanes<Real> E[3][3];      ///< the E_k on its diagonal
  Lanes<Real> Q[3][3];      ///< q_k in its columns
  Lanes<Real> slope[3][3];  ///< twice the divided differences of the half logarithm at 1 + E_k

  SPRINGPROOF_INLINE Principal(const Lanes<Real> (&D)[3][3], const Lanes<Real>& dilatation) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        E[i][j] = D[i][j] + D[j][i] + (D[0][i] * D[0][j] + D[1][i] * D[1][j] + D[2][i] * D[2][j]);
    stdx::where(dilatation + Real(1) < Real(1e-30), E[0][0]) = Real(__builtin_nan(""));
    find_eigenvectors<Real>(E, Q);
    for (int p = 0; p < 3; ++p)
      for (int q = p; q < 3; ++q) {
        const Lanes<Real> above = E[q][q] + Real(1), t = (E[p][p] - E[q][q]) / above;
        slope[p][q] = slope[q][p] = (p == q ? Lanes<Real>(1) : logarithm_over<Real>(t)) / above;
      }
  }
};

/// Of the patterns in y, over their norm.
template <class Real>
constexpr Real norm_of_pattern(int m) {
  return m < 3 ? Real(0.5) : Real(1);
}

/// y of MeasuredCells; v = F^T S.
template <class Real>
SPRINGPROOF_INLINE void deformations(const Principal<Real>& at, const Lanes<Real>& edge, const Lanes<Real> (&v)[4][3],
                                     Lanes<Real> (&y)[18]) {
  Lanes<Real> half_log[3];
  for (int k = 0; k < 3; ++k) half_log[k] = Real(0.5) * logarithm_of_1_and<Real>(at.E[k][k]);
  for (int e = 0; e < 6; ++e) {
    const Lanes<Real>*a = at.Q[strain_of[e][0]], *b = at.Q[strain_of[e][1]];
    y[e] = (a[0] * b[0] * half_log[0] + a[1] * b[1] * half_log[1] + a[2] * b[2] * half_log[2]) * edge;
    if (e > 2) y[e] += y[e];
  }
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j) y[6 + 3 * m + j] = norm_of_pattern<Real>(m) * edge * v[m][j];
}

/// M = A Q.
template <class Real>
SPRINGPROOF_INLINE void product(const Lanes<Real> (&A)[3][3], const Lanes<Real> (&Q)[3][3], Lanes<Real> (&M)[3][3]) {
  for (int i = 0; i < 3; ++i)
    for (int p = 0; p < 3; ++p) M[i][p] = A[i][0] * Q[0][p] + A[i][1] * Q[1][p] + A[i][2] * Q[2][p];
}

/// y += times y' over the edge, of rates F' and v' = F'^T S + F^T S'.
template <class Real>
SPRINGPROOF_INLINE void add_rates(const Principal<Real>& at, const Lanes<Real>& times, const Lanes<Real> (&F)[3][3],
                                  const Lanes<Real> (&F_rate)[3][3], const Lanes<Real> (&v_rate)[4][3],
                                  Lanes<Real> (&y)[18]) {
  using V = Lanes<Real>;
  V FQ[3][3], GQ[3][3], T[3][3];
  product<Real>(F, at.Q, FQ);
  product<Real>(F_rate, at.Q, GQ);
  for (int p = 0; p < 3; ++p)  // the rate of log U in axes of the eigenvectors
    for (int q = p; q < 3; ++q)
      T[p][q] = T[q][p] = Real(0.5) * at.slope[p][q] *
                          ((FQ[0][p] * GQ[0][q] + FQ[1][p] * GQ[1][q] + FQ[2][p] * GQ[2][q]) +
                           (GQ[0][p] * FQ[0][q] + GQ[1][p] * FQ[1][q] + GQ[2][p] * FQ[2][q]));
  for (int e = 0; e < 6; ++e) {
    const V *a = at.Q[strain_of[e][0]], *b = at.Q[strain_of[e][1]];
    V rate = 0;
    for (int p = 0; p < 3; ++p) rate += a[p] * (T[p][0] * b[0] + T[p][1] * b[1] + T[p][2] * b[2]);
    y[e] += (e < 3 ? times : times + times) * rate;
  }
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j) y[6 + 3 * m + j] += norm_of_pattern<Real>(m) * times * v_rate[m][j];
}

/// P = dW/dF over the edge, and w += that of the patterns over their norm, of s = dW/dy.
template <class Real>
SPRINGPROOF_INLINE void measured_stress(const Principal<Real>& at, const Lanes<Real> (&F)[3][3],
                                        const Lanes<Real> (&s)[18], Lanes<Real> (&P)[3][3], Lanes<Real> (&w)[4][3]) {
  using V = Lanes<Real>;
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j) w[m][j] += norm_of_pattern<Real>(m) * s[6 + 3 * m + j];
  const V(&Q)[3][3] = at.Q;
  V T[3][3], FQ[3][3];
  for (int p = 0; p < 3; ++p)
    for (int q = p; q < 3; ++q) {  // in axes of the eigenvectors, times the divided difference of the half logarithm
      V along = 0;
      for (int e = 0; e < 6; ++e) {
        const int i = strain_of[e][0], j = strain_of[e][1];
        along += s[e] * (e < 3 ? Q[i][p] * Q[i][q] : Q[i][p] * Q[j][q] + Q[j][p] * Q[i][q]);
      }
      T[p][q] = T[q][p] = along * at.slope[p][q];  // twice it
    }
  product<Real>(F, Q, FQ);
  for (int i = 0; i < 3; ++i) {
    V of_row[3];
    for (int q = 0; q < 3; ++q) of_row[q] = FQ[i][0] * T[0][q] + FQ[i][1] * T[1][q] + FQ[i][2] * T[2][q];
    for (int j = 0; j < 3; ++j) P[i][j] = of_row[0] * Q[j][0] + of_row[1] * Q[j][1] + of_row[2] * Q[j][2];
  }
}

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
