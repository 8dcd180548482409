// First half of momentum dispersion on a lattice: the inflow J of each node.
#include "msm/kernels/compiled/lattice_rows.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {
namespace {

/// Elongations of springs whose ends are (x, y, z) apart; their inverse lengths are stored.
template <int axes, class Real>
SPRINGPROOF_INLINE Lanes<Real> elongation(const Lanes<Real>& x, const Lanes<Real>& y, const Lanes<Real>& z,
                                          Real* inverse_length) {
  const Lanes<Real> square = x * x + y * y + z * z, inverse = inverse_root(square);
  store<Real>(inverse, inverse_length);
  return square * inverse - Real(root_of(axes));
}

template <class Real>
void inflow_along(const Row<Real>& o, Real* J, Real* inverse_length, const Coefficients<Real>& c, int begin, int end) {
  Lanes<Real> before = 0;
  for (int b = begin; b < end; ++b) {
    const long n = long(b) * lanes<Real>;
    const Real* entry = c.of(b);
    const Lanes<Real> e =
        elongation<1, Real>(load(o.x + n + 1) - load(o.x + n) + Real(1), load(o.y + n + 1) - load(o.y + n),
                            load(o.z + n + 1) - load(o.z + n), inverse_length + n);
    const Lanes<Real> far = coefficient(entry, 1) * e;
    store<Real>(load(J + n) + coefficient(entry, 0) * e + shift_in(before, far), J + n);
    before = far;
  }
}

/// As springs_between().
template <int pair, bool straight, bool slanted, class Real>
void inflow_between(const Row<Real>& o, const Row<Real>& r, Real* J_o, Real* J_r, Real* inverse_length, long stride,
                    const Coefficients<Real>& c, int begin, int end) {
  constexpr int dy = row_pairs[pair][0], dz = row_pairs[pair][1], axes = dy * dy + dz * dz, first = 1 + 3 * (pair - 1);
  Lanes<Real> rising = 0, falling = 0;  // of the block before, to r and to o
  for (int b = begin; b < end; ++b) {
    const long n = long(b) * lanes<Real>;
    const Real* entry = c.of(b) + 2 * first * lanes<Real>;
    Real* kept = inverse_length + first * stride + n;
    const Lanes<Real> ox = load(o.x + n), oy = load(o.y + n) - Real(dy), oz = load(o.z + n) - Real(dz);
    const Lanes<Real> rx = load(r.x + n), ry = load(r.y + n), rz = load(r.z + n);
    Lanes<Real> to_o = load(J_o + n), to_r = load(J_r + n);
    if constexpr (straight) {
      const Lanes<Real> e = elongation<axes, Real>(rx - ox, ry - oy, rz - oz, kept);
      to_o += coefficient(entry, 0) * e;
      to_r += coefficient(entry, 1) * e;
    }
    if constexpr (slanted) {
      const Lanes<Real> up = elongation<axes + 1, Real>(load(r.x + n + 1) - ox + Real(1), load(r.y + n + 1) - oy,
                                                        load(r.z + n + 1) - oz, kept + stride);
      const Lanes<Real> down =
          elongation<axes + 1, Real>(rx - load(o.x + n + 1) - Real(1), ry - (load(o.y + n + 1) - Real(dy)),
                                     rz - (load(o.z + n + 1) - Real(dz)), kept + 2 * stride);
      const Lanes<Real> up_r = coefficient(entry, 3) * up, down_o = coefficient(entry, 4) * down;
      to_o += coefficient(entry, 2) * up + shift_in(falling, down_o);
      to_r += coefficient(entry, 5) * down + shift_in(rising, up_r);
      rising = up_r;
      falling = down_o;
    }
    store(to_o, J_o + n);
    store(to_r, J_r + n);
  }
}

template <int pair, class Real>
void inflow_of_pair(const LatticeView<Real>& l, int y, int z, const Coefficients<Real>& c, const LatticeRun& run) {
  const unsigned kinds = run.flows >> (3 * pair - 2) & 7;
  const Row<Real> o = row_of(l, y, z), r = row_of(l, y + row_pairs[pair][0], z + row_pairs[pair][1]);
  Real *J_o = l.J + (long(z) * l.rows + y) * l.row,
       *J_r = J_o + (row_pairs[pair][0] + long(row_pairs[pair][1]) * l.rows) * l.row;
  Real* kept = inverse_lengths(l, y, z);
  if (kinds == 0) return;
  if (kinds == 1) return inflow_between<pair, true, false>(o, r, J_o, J_r, kept, l.row, c, run.begin, run.end);
  if (kinds % 2 == 0) return inflow_between<pair, false, true>(o, r, J_o, J_r, kept, l.row, c, run.begin, run.end);
  inflow_between<pair, true, true>(o, r, J_o, J_r, kept, l.row, c, run.begin, run.end);
}

}  // namespace

template <class Real>
void inflow(const LatticeView<Real>& l, int z) {
  for (int y = 0; y < l.rows; ++y) {
    const long row = long(z) * l.rows + y;
    const Coefficients<Real> c = {l.inflow_entry + row * l.row_blocks, l.inflow};
    for (int number = l.first_run[row]; number < l.first_run[row + 1]; ++number) {
      const LatticeRun& run = l.runs[number];
      if (run.flows & 1)
        inflow_along(row_of(l, y, z), l.J + row * l.row, inverse_lengths(l, y, z), c, run.begin, run.end);
      inflow_of_pair<1>(l, y, z, c, run);
      inflow_of_pair<2>(l, y, z, c, run);
      inflow_of_pair<3>(l, y, z, c, run);
      inflow_of_pair<4>(l, y, z, c, run);
    }
  }
}

template void inflow(const LatticeView<float>&, int);
template void inflow(const LatticeView<double>&, int);

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
