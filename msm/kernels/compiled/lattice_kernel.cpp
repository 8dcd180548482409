// One time step of a lattice: forces row by row, each row moved as soon as its forces are complete.
#include "msm/kernels/compiled/all_kernels.h"
#include "msm/kernels/compiled/lattice_averaged.h"
#include "msm/kernels/compiled/lattice_hourglass.h"
#include "msm/kernels/compiled/lattice_rows.h"
#include "msm/kernels/compiled/lattice_volume.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {
namespace {

/// Data for the tensions that momentum dispersion adds to the springs between two rows.
template <class Real>
struct Dispersed {
  const Real *o, *r;  ///< J of the two rows
  const Real* inverse_length;
  long stride;
  Coefficients<Real> out;
  Real sign;
};

struct Undispersed {};

/// (k (L' - L) + T) / L' of springs whose ends are (x, y, z) apart, T the tension of dispersion; the ends are at a and
/// b in their rows.
template <int axes, class Real>
SPRINGPROOF_INLINE Lanes<Real> tension_per_length(const Lanes<Real>& k, const Lanes<Real>& x, const Lanes<Real>& y,
                                                  const Lanes<Real>& z, const Undispersed&, int, int, long, long) {
  return k - k * (Real(root_of(axes)) * inverse_root<Real>(x * x + y * y + z * z));
}
template <int axes, class Real>
SPRINGPROOF_INLINE Lanes<Real> tension_per_length(const Lanes<Real>& k, const Lanes<Real>&, const Lanes<Real>&,
                                                  const Lanes<Real>&, const Dispersed<Real>& d, int block,
                                                  int direction, long a, long b) {
  const Real* out = d.out.of(block);
  const Lanes<Real> tension =
      coefficient(out, 2 * direction) * load(d.o + a) + coefficient(out, 2 * direction + 1) * load(d.r + b);
  return k + (d.sign * tension - k * Real(root_of(axes))) *
                 load(d.inverse_length + direction * d.stride + long(block) * lanes<Real>);
}

/// Springs along the row.
template <class Real, class Dispersion>
void springs_along(const Row<Real>& o, const ForceRow<Real>& on_o, const Coefficients<Real>& c,
                   const Dispersion& dispersion, int begin, int end) {
  Force<Real> before;
  for (int b = begin; b < end; ++b) {
    const long n = long(b) * lanes<Real>;
    const Lanes<Real> x = load(o.x + n + 1) - load(o.x + n) + Real(1), y = load(o.y + n + 1) - load(o.y + n),
                      z = load(o.z + n + 1) - load(o.z + n);
    const Lanes<Real> t = tension_per_length<1>(coefficient(c.of(b), 0), x, y, z, dispersion, b, 0, n, n + 1);
    const Force<Real> f = {t * x, t * y, t * z}, far = shifted(before, f);
    add_to(on_o, n, difference(f, far));
    before = f;
  }
}

/// Springs to another row, (dy, dz) away.
template <int pair, bool straight, bool slanted, class Real, class OfStraight, class OfSlanted>
void springs_between(const Row<Real>& o, const Row<Real>& r, const ForceRow<Real>& on_o, const ForceRow<Real>& on_r,
                     const Coefficients<Real>& c, const OfStraight& of_straight, const OfSlanted& of_slanted, int begin,
                     int end) {
  constexpr int dy = row_pairs[pair][0], dz = row_pairs[pair][1], axes = dy * dy + dz * dz, first = 1 + 3 * (pair - 1);
  Force<Real> rising, falling;  // of the block before, on r and on o
  for (int b = begin; b < end; ++b) {
    const long n = long(b) * lanes<Real>;
    const Real* k = c.of(b);
    const Lanes<Real> ox = load(o.x + n), oy = load(o.y + n) - Real(dy), oz = load(o.z + n) - Real(dz);
    const Lanes<Real> rx = load(r.x + n), ry = load(r.y + n), rz = load(r.z + n);
    Force<Real> f_o, f_r;
    if constexpr (straight) {
      const Lanes<Real> x = rx - ox, y = ry - oy, z = rz - oz;
      const Lanes<Real> t = tension_per_length<axes>(coefficient(k, first), x, y, z, of_straight, b, first, n, n);
      add(f_o, t, x, y, z);
      subtract(f_r, t, x, y, z);
    }
    if constexpr (slanted) {
      Lanes<Real> x = load(r.x + n + 1) - ox + Real(1), y = load(r.y + n + 1) - oy, z = load(r.z + n + 1) - oz;
      Lanes<Real> t =
          tension_per_length<axes + 1>(coefficient(k, first + 1), x, y, z, of_slanted, b, first + 1, n, n + 1);
      add(f_o, t, x, y, z);
      const Force<Real> up = {t * x, t * y, t * z};
      x = rx - load(o.x + n + 1) - Real(1), y = ry - (load(o.y + n + 1) - Real(dy)),
      z = rz - (load(o.z + n + 1) - Real(dz));
      t = tension_per_length<axes + 1>(coefficient(k, first + 2), x, y, z, of_slanted, b, first + 2, n + 1, n);
      subtract(f_r, t, x, y, z);
      const Force<Real> down = {t * x, t * y, t * z};
      f_o = sum(f_o, shifted(falling, down));
      f_r = difference(f_r, shifted(rising, up));
      rising = up;
      falling = down;
    }
    add_to(on_o, n, f_o);
    add_to(on_r, n, f_r);
  }
}

/// A block of one component: v' = (v + dt f / m) decay, u' = u + dt v'; the forces are reset to zero.
template <LatticeFinish finish, class Real>
SPRINGPROOF_INLINE void finish_block(Real* f, const Lanes<Real>& inverse_mass, const Lanes<Real>& external, Real* u,
                                     Real* v, Real* stored, const LatticeStep<Real>& step, Lanes<Real>& free,
                                     Lanes<Real>& fixed) {
  const Lanes<Real> internal = load(f);
  store(Lanes<Real>(0), f);
  if constexpr (finish == LatticeFinish::store_forces) {
    store(internal, stored);
    return;
  }
  const Lanes<Real> force = internal + external;
  if constexpr (finish == LatticeFinish::move_and_measure) {
    Lanes<Real> square = force * force;
    Lanes<Real> held = square;
    stdx::where(inverse_mass == Real(0), square) = 0;
    free += square;
    fixed += held - square;
  }
  const Lanes<Real> speed = (load(v) + (step.time_step * inverse_mass) * force) * step.decay;
  store(speed, v);
  store<Real>(load(u) + step.time_step * speed, u);
}

template <class Real>
double total(const Lanes<Real>& v) {
  Real values[lanes<Real>];
  store(v, values);
  double sum = 0;
  for (Real value : values) sum += double(value);
  return sum;
}

template <LatticeFinish finish, class Real>
void finish_row(const LatticeView<Real>& l, long row, long at, const ForceRow<Real>& f, const LatticeStep<Real>& step,
                LatticeSums& sums) {
  Lanes<Real> free = 0, fixed = 0;
  const Coefficients<Real> c = {l.node_entry + row * l.row_blocks, l.nodes};
  for (int run = l.first_run[row]; run < l.first_run[row + 1]; ++run)
    for (int b = l.runs[run].begin; b < l.runs[run].end; ++b) {
      const Real* node = c.of(b);
      const long n = long(b) * lanes<Real>, g = at + n;
      Real* const force[3] = {f.x, f.y, f.z};
      for (int i = 0; i < 3; ++i)
        finish_block<finish>(force[i] + n, coefficient(node, i), coefficient(node, 3 + i), l.u[i] + g, l.v[i] + g,
                             finish == LatticeFinish::store_forces ? step.force[i] + g : nullptr, step, free, fixed);
    }
  if (finish == LatticeFinish::move_and_measure) {
    sums.free += total(free);
    sums.fixed += total(fixed);
  }
}

template <class Real>
void finish_row(const LatticeView<Real>& l, int y, int z, const ForceRow<Real>& f, const LatticeStep<Real>& step,
                LatticeSums& sums) {
  const long row = long(z) * l.rows + y, at = z * l.plane + y * l.row;
  switch (step.finish) {
    case LatticeFinish::move:
      return finish_row<LatticeFinish::move>(l, row, at, f, step, sums);
    case LatticeFinish::move_and_measure:
      return finish_row<LatticeFinish::move_and_measure>(l, row, at, f, step, sums);
    case LatticeFinish::store_forces:
      return finish_row<LatticeFinish::store_forces>(l, row, at, f, step, sums);
  }
}

/// The rows that a row exchanges forces with, in the order of row_pairs.
template <class Real>
struct Neighbours {
  Row<Real> at[lattice_pairs];
  ForceRow<Real> on[lattice_pairs];
};

template <int pair, class Real, class OfStraight, class OfSlanted>
void pair_of_rows(const Neighbours<Real>& n, const Coefficients<Real>& c, const OfStraight& of_straight,
                  const OfSlanted& of_slanted, const LatticeRun& run) {
  const unsigned kinds = run.springs >> (3 * pair - 2) & 7;
  const Row<Real>&o = n.at[0], &r = n.at[pair];
  const ForceRow<Real>&on_o = n.on[0], &on_r = n.on[pair];
  if (kinds == 0) return;
  if (kinds == 1)
    return springs_between<pair, true, false>(o, r, on_o, on_r, c, of_straight, of_slanted, run.begin, run.end);
  if (kinds % 2 == 0)
    return springs_between<pair, false, true>(o, r, on_o, on_r, c, of_straight, of_slanted, run.begin, run.end);
  springs_between<pair, true, true>(o, r, on_o, on_r, c, of_straight, of_slanted, run.begin, run.end);
}

/// Dispersion data of the springs from row (y, z) to the row of one of its pairs.
template <class Real>
Dispersed<Real> dispersed(const LatticeView<Real>& l, int y, int z, int pair) {
  const long row = long(z) * l.rows + y, other = row + row_pairs[pair][0] + long(row_pairs[pair][1]) * l.rows;
  return {l.J + row * l.row,
          l.J + other * l.row,
          inverse_lengths(l, y, z),
          l.row,
          {l.outflow_entry + row * l.row_blocks, l.outflow},
          l.outflow_sign};
}

template <int pair, class Real>
void pair_of_rows(const LatticeView<Real>& l, const Neighbours<Real>& n, const Coefficients<Real>& c, int y, int z,
                  const LatticeRun& run) {
  const unsigned flows = run.flows >> (3 * pair - 2) & 7;
  if (flows == 0) return pair_of_rows<pair>(n, c, Undispersed{}, Undispersed{}, run);
  const Dispersed<Real> d = dispersed(l, y, z, pair);
  if (flows == 1) return pair_of_rows<pair>(n, c, d, Undispersed{}, run);
  pair_of_rows<pair>(n, c, d, d, run);
}

template <class Real>
void forces_of_run(const LatticeView<Real>& l, const Neighbours<Real>& r, const Coefficients<Real>& c, int y, int z,
                   const LatticeRun& run) {
  if (run.flows & 1)
    springs_along(r.at[0], r.on[0], c, dispersed(l, y, z, 0), run.begin, run.end);
  else if (run.springs & 1)
    springs_along(r.at[0], r.on[0], c, Undispersed{}, run.begin, run.end);
  pair_of_rows<1>(l, r, c, y, z, run);
  pair_of_rows<2>(l, r, c, y, z, run);
  pair_of_rows<3>(l, r, c, y, z, run);
  pair_of_rows<4>(l, r, c, y, z, run);
  if (!run.volume && !run.hourglass) return;
  const Row<Real> rows[4] = {r.at[0], r.at[1], r.at[3], r.at[4]};
  const ForceRow<Real> on[4] = {r.on[0], r.on[1], r.on[3], r.on[4]};
  if (run.volume && l.bounded)
    volume_of_cells<true>(rows, on, c, run.begin, run.end);
  else if (run.volume)
    volume_of_cells<false>(rows, on, c, run.begin, run.end);
  if (!run.hourglass) return;
  if (l.corrected) hourglass_of_cells(rows, on, c, l.hourglass, run.begin, run.end);
  if (!l.viscous) return averaged_of_cells<false>(rows, rows, on, c, l, run.begin, run.end);
  const Row<Real> moving[4] = {velocities_of(l, y, z), velocities_of(l, y + 1, z), velocities_of(l, y, z + 1),
                               velocities_of(l, y + 1, z + 1)};
  averaged_of_cells<true>(rows, moving, on, c, l, run.begin, run.end);
}

template <class Real>
ForceRow<Real> ring_row(const LatticeView<Real>& l, const LatticeSlab<Real>& slab, long number) {
  Real* p = slab.ring + number % (l.rows + 2) * 3 * l.row;
  return {p, p + l.row, p + 2 * l.row};
}

template <class Real>
ForceRow<Real> first_row(const LatticeView<Real>& l, const LatticeSlab<Real>& slab, int y) {
  Real* p = slab.first + y * 3 * l.row;
  return {p, p + l.row, p + 2 * l.row};
}

/// to += from; resets `from` to zero if `empty`.
template <bool empty, class Real>
void take(const LatticeView<Real>& l, long row, const ForceRow<Real>& from, const ForceRow<Real>& to) {
  Real* const source[3] = {from.x, from.y, from.z};
  Real* const target[3] = {to.x, to.y, to.z};
  for (int run = l.first_run[row]; run < l.first_run[row + 1]; ++run)
    for (int i = 0; i < 3; ++i)
      for (long n = long(l.runs[run].begin) * lanes<Real>; n < long(l.runs[run].end) * lanes<Real>; n += lanes<Real>) {
        store<Real>(load(target[i] + n) + load(source[i] + n), target[i] + n);
        if (empty) store(Lanes<Real>(0), source[i] + n);
      }
}

template <class Real>
void sweep(const LatticeView<Real>& l, const LatticeSlab<Real>& slab, int begin, int end, const LatticeStep<Real>& step,
           LatticeSums& sums) {
  for (int z = begin; z < end; ++z)
    for (int y = 0; y < l.rows; ++y) {
      const long row = long(z) * l.rows + y;
      if (l.first_run[row] == l.first_run[row + 1]) continue;
      Neighbours<Real> r;
      for (int p = 0; p < lattice_pairs; ++p) {
        r.at[p] = row_of(l, y + row_pairs[p][0], z + row_pairs[p][1]);
        r.on[p] = ring_row(l, slab, long(z + row_pairs[p][1] - slab.begin) * l.rows + y + row_pairs[p][0]);
      }
      const Coefficients<Real> c = {l.spring_entry + row * l.row_blocks, l.springs};
      for (int run = l.first_run[row]; run < l.first_run[row + 1]; ++run) forces_of_run(l, r, c, y, z, l.runs[run]);
      if (slab.first && z == slab.begin)
        take<true>(l, row, r.on[0], first_row(l, slab, y));
      else
        finish_row(l, y, z, r.on[0], step, sums);
    }
}

template <class Real>
void finish_first(const LatticeView<Real>& l, const LatticeSlab<Real>& slab, const LatticeSlab<Real>& below,
                  const LatticeStep<Real>& step, LatticeSums& sums) {
  for (int y = 0; y < l.rows; ++y) {
    const ForceRow<Real> f = first_row(l, slab, y);
    take<false>(l, long(slab.begin) * l.rows + y, ring_row(l, below, long(slab.begin - below.begin) * l.rows + y), f);
    finish_row(l, y, slab.begin, f, step, sums);
  }
}

}  // namespace

template <class Real>
LatticeKernels<Real> lattice_kernels() {
  return {.lanes = lanes<Real>,
          .inflow = inflow<Real>,
          .sweep = sweep<Real>,
          .finish_first = finish_first<Real>,
          .average = average<Real>};
}

template LatticeKernels<double> lattice_kernels();
template LatticeKernels<float> lattice_kernels();

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
