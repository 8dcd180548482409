// One time step of a lattice: forces row by row, each row moved as soon as it has all of its own.
#include "msm/kernels/lattice_kernel.h"

#include <type_traits>

#include "msm/kernels/simd_math.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {
namespace {

template <class Real>
struct Row {
  const Real *x, *y, *z;
};
template <class Real>
struct ForceRow {
  Real *x, *y, *z;
};

/// Coefficients of the blocks of a row.
template <class Real>
struct Coefficients {
  const int* entry;
  const Real* table;
  const Real* of(int block) const { return table + entry[block]; }
};

template <class Real>
struct Force {
  Lanes<Real> x = 0, y = 0, z = 0;
};

template <class Real>
SPRINGPROOF_INLINE Lanes<Real> coefficient(const Real* entry, int number) {
  return load(entry + number * lanes<Real>);
}

constexpr double root_of(int n) { return n == 1 ? 1.0 : n == 2 ? 1.41421356237309504880 : 1.73205080756887729353; }

/// What the springs of a row get by momentum dispersion, given what its nodes have.
template <class Real>
struct Dispersed {
  const Real *o, *r;  ///< J of the two rows
  Coefficients<Real> c;

  /// Tension of springs of a direction, whose ends are at a in row o and at b in row r.
  SPRINGPROOF_INLINE Lanes<Real> tension(int block, int direction, long a, long b) const {
    const Real* entry = c.of(block);
    return coefficient(entry, 4 * direction + 1) * load(o + a) + coefficient(entry, 4 * direction + 3) * load(r + b);
  }
};

struct Undispersed {};

/// (k (L' - L) + T) / L' of springs whose ends are (x, y, z) apart, T by dispersion.
template <int axes, class Real, class Dispersion>
SPRINGPROOF_INLINE Lanes<Real> tension_per_length(const Lanes<Real>& k, const Lanes<Real>& x, const Lanes<Real>& y, const Lanes<Real>& z,
                                                  const Dispersion& dispersion, int block, int direction, long a, long b) {
  const Lanes<Real> square = x * x + y * y + z * z;
  if constexpr (std::is_same_v<Dispersion, Undispersed>) return k - k * (Real(root_of(axes)) / stdx::sqrt(square));
  else return k + (dispersion.tension(block, direction, a, b) - k * Real(root_of(axes))) / stdx::sqrt(square);
}

template <class Real>
SPRINGPROOF_INLINE void add(Force<Real>& f, const Lanes<Real>& t, const Lanes<Real>& x, const Lanes<Real>& y, const Lanes<Real>& z) {
  f.x += t * x;
  f.y += t * y;
  f.z += t * z;
}
template <class Real>
SPRINGPROOF_INLINE void subtract(Force<Real>& f, const Lanes<Real>& t, const Lanes<Real>& x, const Lanes<Real>& y, const Lanes<Real>& z) {
  f.x -= t * x;
  f.y -= t * y;
  f.z -= t * z;
}

template <class Real>
SPRINGPROOF_INLINE void add_to(const ForceRow<Real>& row, long n, const Force<Real>& f) {
  store<Real>(load(row.x + n) + f.x, row.x + n);
  store<Real>(load(row.y + n) + f.y, row.y + n);
  store<Real>(load(row.z + n) + f.z, row.z + n);
}

template <class Real>
SPRINGPROOF_INLINE Force<Real> shifted(const Force<Real>& before, const Force<Real>& f) {
  return {shift_in(before.x, f.x), shift_in(before.y, f.y), shift_in(before.z, f.z)};
}

template <class Real>
SPRINGPROOF_INLINE Force<Real> sum(const Force<Real>& a, const Force<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class Real>
SPRINGPROOF_INLINE Force<Real> difference(const Force<Real>& a, const Force<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Springs along the row.
template <class Real, class Dispersion>
void springs_along(const Row<Real>& o, const ForceRow<Real>& on_o, const Coefficients<Real>& c, const Dispersion& dispersion, int begin, int end) {
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
template <int pair, bool straight, bool slanted, class Real, class Dispersion>
void springs_between(const Row<Real>& o, const Row<Real>& r, const ForceRow<Real>& on_o, const ForceRow<Real>& on_r,
                     const Coefficients<Real>& c, const Dispersion& dispersion, int begin, int end) {
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
      const Lanes<Real> t = tension_per_length<axes>(coefficient(k, first), x, y, z, dispersion, b, first, n, n);
      add(f_o, t, x, y, z);
      subtract(f_r, t, x, y, z);
    }
    if constexpr (slanted) {
      Lanes<Real> x = load(r.x + n + 1) - ox + Real(1), y = load(r.y + n + 1) - oy, z = load(r.z + n + 1) - oz;
      Lanes<Real> t = tension_per_length<axes + 1>(coefficient(k, first + 1), x, y, z, dispersion, b, first + 1, n, n + 1);
      add(f_o, t, x, y, z);
      const Force<Real> up = {t * x, t * y, t * z};
      x = rx - load(o.x + n + 1) - Real(1), y = ry - (load(o.y + n + 1) - Real(dy)), z = rz - (load(o.z + n + 1) - Real(dz));
      t = tension_per_length<axes + 1>(coefficient(k, first + 2), x, y, z, dispersion, b, first + 2, n + 1, n);
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

/// Pressure of a cell of J times its volume, per kappa.
template <bool bounded, class Real>
SPRINGPROOF_INLINE Lanes<Real> pressure(const Lanes<Real>& J) {
  if constexpr (bounded) {
    const Lanes<Real> y = inverse_cube_root(J);  // 3 (J^(1/3) - 1) / J^(2/3)
    return Real(3) * y * (Real(1) - y);
  } else {
    return J - Real(1);
  }
}

/// Forces of the cells between four rows, which have (y, z) offsets 00, 10, 01, 11 from the first.
template <bool bounded, class Real>
void volume_of_cells(const Row<Real> (&r)[4], const ForceRow<Real> (&on)[4], const Coefficients<Real>& c, int begin, int end) {
  using V = Lanes<Real>;
  Force<Real> before[3];  // bc, ca, ab
  const Real quarter = Real(0.25);
  for (int b = begin; b < end; ++b) {
    const long n = long(b) * lanes<Real>;
    V a[3], bb[3], cc[3];
    const auto edges = [&](const Real* p00, const Real* p10, const Real* p01, const Real* p11, int i) {
      const V low0 = load(p00 + n), low1 = load(p10 + n), low2 = load(p01 + n), low3 = load(p11 + n);
      const V high0 = load(p00 + n + 1), high1 = load(p10 + n + 1), high2 = load(p01 + n + 1), high3 = load(p11 + n + 1);
      const V m0 = low0 + high0, m1 = low1 + high1, m2 = low2 + high2, m3 = low3 + high3;
      a[i] = quarter * (((high0 - low0) + (high1 - low1)) + ((high2 - low2) + (high3 - low3)));
      bb[i] = quarter * ((m1 - m0) + (m3 - m2));
      cc[i] = quarter * ((m2 - m0) + (m3 - m1));
    };
    edges(r[0].x, r[1].x, r[2].x, r[3].x, 0);
    edges(r[0].y, r[1].y, r[2].y, r[3].y, 1);
    edges(r[0].z, r[1].z, r[2].z, r[3].z, 2);
    a[0] += Real(1);
    bb[1] += Real(1);
    cc[2] += Real(1);
    const auto cross = [](const V (&p)[3], const V (&q)[3]) -> Force<Real> {
      return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
    };
    Force<Real> bc = cross(bb, cc), ca = cross(cc, a), ab = cross(a, bb);
    const V J = a[0] * bc.x + a[1] * bc.y + a[2] * bc.z;
    const V p = quarter * coefficient(c.of(b), lattice_directions) * pressure<bounded>(J);
    const auto scale = [&](Force<Real>& f) { f.x *= p, f.y *= p, f.z *= p; };
    scale(bc);
    scale(ca);
    scale(ab);
    // A corner with signs (sx, sy, sz) gets -(sx bc + sy ca + sz ab); those of high x belong one further on.
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

/// A block of one component: v' = (v + dt f / m) decay, u' = u + dt v'; the forces' place is left empty.
template <LatticeFinish finish, class Real>
SPRINGPROOF_INLINE void finish_block(Real* f, const Lanes<Real>& inverse_mass, const Lanes<Real>& external, Real* u, Real* v, Real* stored,
                         const LatticeStep<Real>& step, Lanes<Real>& free, Lanes<Real>& fixed) {
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
void finish_row(const LatticeView<Real>& l, long row, long at, const ForceRow<Real>& f, const LatticeStep<Real>& step, LatticeSums& sums) {
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
void finish_row(const LatticeView<Real>& l, int y, int z, const ForceRow<Real>& f, const LatticeStep<Real>& step, LatticeSums& sums) {
  const long row = long(z) * l.rows + y, at = z * l.plane + y * l.row;
  switch (step.finish) {
    case LatticeFinish::move: return finish_row<LatticeFinish::move>(l, row, at, f, step, sums);
    case LatticeFinish::move_and_measure: return finish_row<LatticeFinish::move_and_measure>(l, row, at, f, step, sums);
    case LatticeFinish::store_forces: return finish_row<LatticeFinish::store_forces>(l, row, at, f, step, sums);
  }
}

/// The rows that a row exchanges forces with, in the order of row_pairs.
template <class Real>
struct Neighbours {
  Row<Real> at[lattice_pairs];
  ForceRow<Real> on[lattice_pairs];
};

template <int pair, class Real, class Dispersion>
void pair_of_rows(const Neighbours<Real>& n, const Coefficients<Real>& c, const Dispersion& dispersion, const LatticeRun& run) {
  const unsigned kinds = run.springs >> (3 * pair - 2) & 7;
  const Row<Real>&o = n.at[0], &r = n.at[pair];
  const ForceRow<Real>&on_o = n.on[0], &on_r = n.on[pair];
  if (kinds == 0) return;
  if (kinds == 1) return springs_between<pair, true, false>(o, r, on_o, on_r, c, dispersion, run.begin, run.end);
  if (kinds % 2 == 0) return springs_between<pair, false, true>(o, r, on_o, on_r, c, dispersion, run.begin, run.end);
  springs_between<pair, true, true>(o, r, on_o, on_r, c, dispersion, run.begin, run.end);
}

/// `dispersion_to(pair)`: of the springs to that row.
template <class Real, class DispersionTo>
void springs_of_run(const Neighbours<Real>& r, const Coefficients<Real>& c, const LatticeRun& run, const DispersionTo& dispersion_to) {
  if (run.springs & 1) springs_along(r.at[0], r.on[0], c, dispersion_to(0), run.begin, run.end);
  pair_of_rows<1>(r, c, dispersion_to(1), run);
  pair_of_rows<2>(r, c, dispersion_to(2), run);
  pair_of_rows<3>(r, c, dispersion_to(3), run);
  pair_of_rows<4>(r, c, dispersion_to(4), run);
}

template <class Real>
void forces_of_run(const LatticeView<Real>& l, const Neighbours<Real>& r, const Coefficients<Real>& c, long row, const LatticeRun& run) {
  if (l.J) {
    const Coefficients<Real> coefficients = {l.dispersion_entry + row * l.row_blocks, l.dispersion};
    springs_of_run(r, c, run, [&](int pair) {
      const long other = row + row_pairs[pair][0] + long(row_pairs[pair][1]) * l.rows;
      return Dispersed<Real>{l.J + row * l.row, l.J + other * l.row, coefficients};
    });
  } else {
    springs_of_run(r, c, run, [](int) { return Undispersed{}; });
  }
  if (!run.cells) return;
  const Row<Real> rows[4] = {r.at[0], r.at[1], r.at[3], r.at[4]};
  const ForceRow<Real> on[4] = {r.on[0], r.on[1], r.on[3], r.on[4]};
  if (l.bounded) volume_of_cells<true>(rows, on, c, run.begin, run.end);
  else volume_of_cells<false>(rows, on, c, run.begin, run.end);
}

/// Springs of one kind, `rise` = x of their end less x of their start: what flows in to the nodes at both ends.
template <int axes, class Real>
void inflow_of_springs(const Row<Real>& o, const Row<Real>& r, int dy, int dz, int rise, Real* J_o, Real* J_r,
                       const Coefficients<Real>& c, int direction, int begin, int end) {
  const long to_o = rise < 0 ? 1 : 0, to_r = rise > 0 ? 1 : 0;
  Lanes<Real> before = 0;
  for (int b = begin; b < end; ++b) {
    const long n = long(b) * lanes<Real>;
    const Lanes<Real> x = load(r.x + n + to_r) - load(o.x + n + to_o) + Real(rise), y = load(r.y + n + to_r) - load(o.y + n + to_o) + Real(dy),
                      z = load(r.z + n + to_r) - load(o.z + n + to_o) + Real(dz);
    const Lanes<Real> elongation = stdx::sqrt(x * x + y * y + z * z) - Real(root_of(axes));
    Lanes<Real> in_o = coefficient(c.of(b), 4 * direction) * elongation, in_r = coefficient(c.of(b), 4 * direction + 2) * elongation;
    Lanes<Real>& moved = rise < 0 ? in_o : in_r;  // belongs one node further on
    if (rise != 0) {
      const Lanes<Real> own = moved;
      moved = shift_in(before, own);
      before = own;
    }
    store<Real>(load(J_o + n) + in_o, J_o + n);
    store<Real>(load(J_r + n) + in_r, J_r + n);
  }
}

template <int pair, class Real>
void inflow_between(const LatticeView<Real>& l, const Row<Real>& o, const Row<Real>& r, const Coefficients<Real>& c, long row, const LatticeRun& run) {
  constexpr int dy = row_pairs[pair][0], dz = row_pairs[pair][1], axes = dy * dy + dz * dz, first = pair == 0 ? -1 : 1 + 3 * (pair - 1);
  Real *J_o = l.J + row * l.row, *J_r = J_o + (dy + long(dz) * l.rows) * l.row;
  const auto has = [&](int direction) { return run.springs >> direction & 1; };
  if constexpr (pair > 0) {
    if (has(first)) inflow_of_springs<axes>(o, r, dy, dz, 0, J_o, J_r, c, first, run.begin, run.end);
    if (has(first + 2)) inflow_of_springs<axes + 1>(o, r, dy, dz, -1, J_o, J_r, c, first + 2, run.begin, run.end);
  }
  if (has(first + 1)) inflow_of_springs<axes + 1>(o, r, dy, dz, 1, J_o, J_r, c, first + 1, run.begin, run.end);
}

template <class Real>
Row<Real> row_of(const LatticeView<Real>& l, int y, int z) {
  const long at = z * l.plane + y * l.row;
  return {l.u[0] + at, l.u[1] + at, l.u[2] + at};
}

template <class Real>
void inflow(const LatticeView<Real>& l, int y, int z) {
  const long row = long(z) * l.rows + y;
  const Coefficients<Real> c = {l.dispersion_entry + row * l.row_blocks, l.dispersion};
  Row<Real> at[lattice_pairs];
  for (int p = 0; p < lattice_pairs; ++p) at[p] = row_of(l, y + row_pairs[p][0], z + row_pairs[p][1]);
  for (int run = l.first_run[row]; run < l.first_run[row + 1]; ++run) {
    inflow_between<0>(l, at[0], at[0], c, row, l.runs[run]);
    inflow_between<1>(l, at[0], at[1], c, row, l.runs[run]);
    inflow_between<2>(l, at[0], at[2], c, row, l.runs[run]);
    inflow_between<3>(l, at[0], at[3], c, row, l.runs[run]);
    inflow_between<4>(l, at[0], at[4], c, row, l.runs[run]);
  }
}

template <class Real>
void inflow(const LatticeView<Real>& l) {
  for (int z = 0; z < l.planes; ++z)
    for (int y = 0; y < l.rows; ++y) inflow(l, y, z);
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

/// to += from, which is left empty.
template <class Real>
void take(const LatticeView<Real>& l, long row, const ForceRow<Real>& from, const ForceRow<Real>& to) {
  Real* const source[3] = {from.x, from.y, from.z};
  Real* const target[3] = {to.x, to.y, to.z};
  for (int run = l.first_run[row]; run < l.first_run[row + 1]; ++run)
    for (int i = 0; i < 3; ++i)
      for (long n = long(l.runs[run].begin) * lanes<Real>; n < long(l.runs[run].end) * lanes<Real>; n += lanes<Real>) {
        store<Real>(load(target[i] + n) + load(source[i] + n), target[i] + n);
        store(Lanes<Real>(0), source[i] + n);
      }
}

template <class Real>
void sweep(const LatticeView<Real>& l, const LatticeSlab<Real>& slab, int begin, int end, const LatticeStep<Real>& step, LatticeSums& sums) {
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
      for (int run = l.first_run[row]; run < l.first_run[row + 1]; ++run) forces_of_run(l, r, c, row, l.runs[run]);
      if (slab.first && z == slab.begin) take(l, row, r.on[0], first_row(l, slab, y));
      else finish_row(l, y, z, r.on[0], step, sums);
    }
}

template <class Real>
void finish_first(const LatticeView<Real>& l, const LatticeSlab<Real>& slab, const LatticeSlab<Real>& below,
                  const LatticeStep<Real>& step, LatticeSums& sums) {
  for (int y = 0; y < l.rows; ++y) {
    const ForceRow<Real> f = first_row(l, slab, y);
    take(l, long(slab.begin) * l.rows + y, ring_row(l, below, long(slab.begin - below.begin) * l.rows + y), f);
    finish_row(l, y, slab.begin, f, step, sums);
  }
}

template <class Real>
void get(LatticeKernels<Real>& k) {
  k.lanes = lanes<Real>;
  k.inflow = inflow<Real>;
  k.sweep = sweep<Real>;
  k.finish_first = finish_first<Real>;
}

}  // namespace

void get_lattice_kernels(LatticeKernels<float>& k) { get(k); }
void get_lattice_kernels(LatticeKernels<double>& k) { get(k); }

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
