// Hourglass correction of a row of cells.  For the lattice kernels only.
#pragma once

#include "msm/kernels/compiled/lattice_rows.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

/// One component in a cell's patterns xi_x xi_y, xi_x xi_z, xi_y xi_z (xi = -1, 1 at low and high corners).
template <class Real>
struct Patterns {
  Lanes<Real> xy = 0, xz = 0, yz = 0;
};

/// Sums of a component over the corners of the cells between four rows, which have (y, z) offsets 00, 10, 01, 11.
template <class Real>
SPRINGPROOF_INLINE Patterns<Real> patterns_of(const Real* r00, const Real* r10, const Real* r01, const Real* r11,
                                              long n) {
  const Real* const rows[4] = {r00, r10, r01, r11};
  Lanes<Real> d[4], m[4];
  for (int i = 0; i < 4; ++i) {
    const Lanes<Real> low = load(rows[i] + n), high = load(rows[i] + n + 1);
    d[i] = high - low;
    m[i] = high + low;
  }
  return {(d[1] - d[0]) + (d[3] - d[2]), (d[2] - d[0]) + (d[3] - d[1]), (m[0] - m[1]) + (m[3] - m[2])};
}

/// Adds to the nodes at x the forces of the cells on both sides of them in x; `before`: patterns of the previous block.
template <class Real>
SPRINGPROOF_INLINE void add_patterns(Real* f00, Real* f10, Real* f01, Real* f11, long n, const Patterns<Real>& g,
                                     Patterns<Real>& before) {
  const Lanes<Real> U = g.yz + shift_in(before.yz, g.yz), P = shift_in(before.xy, g.xy) - g.xy,
                    Q = shift_in(before.xz, g.xz) - g.xz;
  before = g;
  const Lanes<Real> sum = P + Q, difference = P - Q;
  store<Real>(load(f00 + n) + (U - sum), f00 + n);
  store<Real>(load(f10 + n) - (U - difference), f10 + n);
  store<Real>(load(f01 + n) - (U + difference), f01 + n);
  store<Real>(load(f11 + n) + (U + sum), f11 + n);
}

/// Forces of the cells between four rows, as HourglassCorrection: a bending mode of each component in each of its own
/// patterns, coupled in pairs that share a neutral plane; torsional modes in the third.
template <class Real>
void hourglass_of_cells(const Row<Real> (&r)[4], const ForceRow<Real> (&on)[4], const Coefficients<Real>& c,
                        const LatticeHourglass<Real>& k, int begin, int end) {
  Patterns<Real> before[3];
  for (int b = begin; b < end; ++b) {
    const long n = long(b) * lanes<Real>;
    const Patterns<Real> x = patterns_of(r[0].x, r[1].x, r[2].x, r[3].x, n),
                         y = patterns_of(r[0].y, r[1].y, r[2].y, r[3].y, n),
                         z = patterns_of(r[0].z, r[1].z, r[2].z, r[3].z, n);
    const Lanes<Real> there = coefficient(c.of(b), hourglass_coefficient);
    const Lanes<Real> own = there * k.bending, other = there * k.coupling, twist = there * k.torsion;
    const Lanes<Real> twisted = there * k.torsion_coupling * (x.yz + y.xz + z.xy);
    const Patterns<Real> gx = {-own * x.xy - other * z.yz, -own * x.xz - other * y.yz, -twist * x.yz - twisted},
                         gy = {-own * y.xy - other * z.xz, -twist * y.xz - twisted, -own * y.yz - other * x.xz},
                         gz = {-twist * z.xy - twisted, -own * z.xz - other * y.xy, -own * z.yz - other * x.xy};
    add_patterns(on[0].x, on[1].x, on[2].x, on[3].x, n, gx, before[0]);
    add_patterns(on[0].y, on[1].y, on[2].y, on[3].y, n, gy, before[1]);
    add_patterns(on[0].z, on[1].z, on[2].z, on[3].z, n, gz, before[2]);
  }
}

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
