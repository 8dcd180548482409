// Averaged springs of a row of cells.  For the lattice kernels only.
#pragma once

#include "msm/kernels/compiled/averaged_cells.h"
#include "msm/kernels/compiled/lattice_rows.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

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
    V along[3];
    signed_sums(d, m, along, S[i]);
    for (int j = 0; j < 3; ++j) D[i][j] = Real(0.25) * along[j];
  }
  const auto absent = present == Real(0);
  if (stdx::any_of(absent))
    for (int i = 0; i < 3; ++i) {
      for (V& entry : D[i]) stdx::where(absent, entry) = Real(0);
      for (V& s : S[i]) stdx::where(absent, s) = Real(0);
    }
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
      turned_back(F, S, v);
      add_hourglass_forces(l.averaged, v, w);
      first_stress<curve>(l.averaged, D, inverse_transposed, dilatation, P);
    }
    if constexpr (viscous) {
      V rate[3][3], S_rate[3][4];
      patterns_of_cells(moving, n, present, rate, S_rate);
      add_viscous_stress(l.dashpots, F, inverse_transposed, rate, P);
      turned_back_rates(F, S, rate, S_rate, v);
      add_hourglass_forces(l.dashpots, v, w);
    }
    for (int i = 0; i < 3; ++i) {
      V A[3], B[4];
      for (int j = 0; j < 3; ++j)
        A[j] =
            Real(0.25) * (P[i][j] + (S[i][0] * w[0][j] + S[i][1] * w[1][j]) + (S[i][2] * w[2][j] + S[i][3] * w[3][j]));
      for (int m = 0; m < 4; ++m) B[m] = F[i][0] * w[m][0] + F[i][1] * w[m][1] + F[i][2] * w[m][2];
      V even[4], odd[4];  // minus the forces
      at_corners(A, B, even, odd);
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
