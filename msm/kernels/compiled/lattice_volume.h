// Volume correction of a row of cells.  For the lattice kernels only.
#pragma once

#include "msm/kernels/compiled/averaged_cells.h"
#include "msm/kernels/compiled/lattice_rows.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

/// Forces of the cells between four rows, which have (y, z) offsets 00, 10, 01, 11 from the first.
template <bool bounded, class Real>
void volume_of_cells(const Row<Real> (&r)[4], const ForceRow<Real> (&on)[4], const Coefficients<Real>& c, int begin,
                     int end) {
  using V = Lanes<Real>;
  Force<Real> before[3];  // bc, ca, ab
  for (int b = begin; b < end; ++b) {
    const long n = long(b) * lanes<Real>;
    V a[3], bb[3], cc[3];  // four times the cell's mean edges
    const auto edges = [&](const Real* p00, const Real* p10, const Real* p01, const Real* p11, int i) {
      const V low0 = load(p00 + n), low1 = load(p10 + n), low2 = load(p01 + n), low3 = load(p11 + n);
      const V high0 = load(p00 + n + 1), high1 = load(p10 + n + 1), high2 = load(p01 + n + 1),
              high3 = load(p11 + n + 1);
      const V m0 = low0 + high0, m1 = low1 + high1, m2 = low2 + high2, m3 = low3 + high3;
      a[i] = ((high0 - low0) + (high1 - low1)) + ((high2 - low2) + (high3 - low3));
      bb[i] = (m1 - m0) + (m3 - m2);
      cc[i] = (m2 - m0) + (m3 - m1);
    };
    edges(r[0].x, r[1].x, r[2].x, r[3].x, 0);
    edges(r[0].y, r[1].y, r[2].y, r[3].y, 1);
    edges(r[0].z, r[1].z, r[2].z, r[3].z, 2);
    a[0] += Real(4);
    bb[1] += Real(4);
    cc[2] += Real(4);
    const auto cross = [](const V(&p)[3], const V(&q)[3]) -> Force<Real> {
      return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
    };
    Force<Real> bc = cross(bb, cc), ca = cross(cc, a), ab = cross(a, bb);
    const V J = Real(1.0 / 64) * (a[0] * bc.x + a[1] * bc.y + a[2] * bc.z),
            kappa = coefficient(c.of(b), kappa_coefficient);
    const V p = Real(1.0 / 64) * kappa * pressure<bounded>(J, kappa);
    const auto scale = [&](Force<Real>& f) { f.x *= p, f.y *= p, f.z *= p; };
    scale(bc);
    scale(ca);
    scale(ab);
    // The force on a corner with signs (sx, sy, sz) is -(sx bc + sy ca + sz ab); corners of high x are the next nodes.
    const Force<Real> far_bc = shifted(before[0], bc), far_ca = shifted(before[1], ca), far_ab = shifted(before[2], ab);
    before[0] = bc, before[1] = ca, before[2] = ab;
    const Force<Real> B = difference(bc, far_bc), C = sum(ca, far_ca), A = sum(ab, far_ab);
    const Force<Real> plus = sum(B, A), minus = difference(B, A);
    add_to(on[0], n, sum(plus, C));
    add_to(on[1], n, difference(plus, C));
    add_to(on[2], n, sum(minus, C));
    add_to(on[3], n, difference(minus, C));
  }
}

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
