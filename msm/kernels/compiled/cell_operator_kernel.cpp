#include "msm/kernels/compiled/all_kernels.h"
#include "msm/kernels/compiled/simd.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {
namespace {

constexpr int margin = 32;  // two of the widest vectors
constexpr int scratch = longest_cell_row + margin;

template <class Real>
constexpr int lanes = static_cast<int>(Lanes<Real>::size());

template <class Real>
int whole_vectors(int n) {
  return (n + lanes<Real> - 1) / lanes<Real> * lanes<Real>;
}

template <class Real>
inline void add(const Lanes<Real>& v, Real* p) {
  store<Real>(load<Real>(p) + v, p);
}

/// The cells' fill at cell i of n, zero beyond the end of the row.
template <class Real>
inline Lanes<Real> fill_at(const Real* fill, int i, int n) {
  if (i + lanes<Real> <= n) return fill ? load<Real>(fill + i) : Lanes<Real>(Real(1));
  Real values[lanes<Real>] = {};
  for (int lane = 0; i + lane < n; ++lane) values[lane] = fill ? fill[i + lane] : Real(1);
  return load<Real>(values);
}

/// The four rows of points of a row of cells, one component.
template <class Real>
struct FourRows {
  const Real *p00, *p10, *p01, *p11;
};

/// Sums and differences along y and z of one component: sum, y, z, yz.
template <class Real>
void transform_across(const FourRows<Real>& u, int points, Real (*b)[scratch]) {
  for (int i = 0; i <= points; i += lanes<Real>) {
    const Lanes<Real> a = load(u.p00 + i), c = load(u.p10 + i), e = load(u.p01 + i), g = load(u.p11 + i);
    const Lanes<Real> low_sum = a + c, low_difference = c - a, high_sum = e + g, high_difference = g - e;
    store<Real>(low_sum + high_sum, b[0] + i);
    store<Real>(low_difference + high_difference, b[1] + i);
    store<Real>(high_sum - low_sum, b[2] + i);
    store<Real>(high_difference - low_difference, b[3] + i);
  }
}

/// One row of cells in sign patterns: component, pattern across, then x; `right`: contribution to each point of the
/// cell before it.
template <class Real>
struct Patterns {
  alignas(64) Real b[3][4][scratch];
  alignas(64) Real right[3][4][scratch];
};

/// Applies the stiffness to the two classes of sign patterns that have `across` (1: y, 2: z) in their first component.
/// with_pressure, with_divergence: for class 0 only.
template <class Real, int across, bool with_pressure, bool with_divergence>
inline void couple(const CellBlocks<Real>& K, int n, const Real* fill, const Real* p, Real* divergence,
                   Patterns<Real>& s) {
  Real *bx = s.b[0][across], *by = s.b[1][across ^ 1], *bz = s.b[2][across ^ 2];
  Real *rx = s.right[0][across] + 1, *ry = s.right[1][across ^ 1] + 1, *rz = s.right[2][across ^ 2] + 1;
  const Real *even = K.m[2 * across], *odd = K.m[2 * across + 1];
  const Lanes<Real> e0 = even[0], e1 = even[1], e2 = even[2], e3 = even[3], e4 = even[4], e5 = even[5];
  const Lanes<Real> o0 = odd[0], o1 = odd[1], o2 = odd[2], o3 = odd[3], o4 = odd[4], o5 = odd[5];
  for (int i = 0; i < n; i += lanes<Real>) {
    const Lanes<Real> xl = load(bx + i), xr = load(bx + i + 1), yl = load(by + i), yr = load(by + i + 1),
                      zl = load(bz + i), zr = load(bz + i + 1);
    const Lanes<Real> xd = xr - xl, ys = yl + yr, zs = zl + zr;
    Lanes<Real> fxd = e0 * xd + e1 * ys + e2 * zs, fys = e1 * xd + e3 * ys + e4 * zs, fzs = e2 * xd + e4 * ys + e5 * zs;
    const Lanes<Real> xs = xl + xr, yd = yr - yl, zd = zr - zl;
    Lanes<Real> fxs = o0 * xs + o1 * yd + o2 * zd, fyd = o1 * xs + o3 * yd + o4 * zd, fzd = o2 * xs + o4 * yd + o5 * zd;
    if constexpr (with_pressure) {
      const Lanes<Real> g = K.gradient * load(p + i);
      fxd += g;
      fys += g;
      fzs += g;
    }
    if (fill || i + lanes < Real >> n) {
      const Lanes<Real> w = fill_at(fill, i, n);
      fxd *= w;
      fys *= w;
      fzs *= w;
      fxs *= w;
      fyd *= w;
      fzd *= w;
      if constexpr (with_divergence) store<Real>(K.gradient * w * (xd + ys + zs), divergence + i);
    } else if constexpr (with_divergence) {
      store<Real>(K.gradient * (xd + ys + zs), divergence + i);
    }
    store<Real>(fxs - fxd, bx + i);
    store<Real>(fxs + fxd, rx + i);
    store<Real>(fys - fyd, by + i);
    store<Real>(fys + fyd, ry + i);
    store<Real>(fzs - fzd, bz + i);
    store<Real>(fzs + fzd, rz + i);
  }
}

/// Zeroes the values beyond the last cell and before the first point, which the coupling does not write.
template <class Real>
void clear_ends(int n, Patterns<Real>& s) {
  const int end = whole_vectors<Real>(n);
  const Lanes<Real> zero = Real(0);
  for (int a = 0; a < 3; ++a)
    for (int t = 0; t < 4; ++t) {
      store<Real>(zero, s.b[a][t] + end);
      store<Real>(zero, s.right[a][t] + end + 1);
      s.right[a][t][0] = 0;
    }
}

template <class Real>
void add_across(const Patterns<Real>& s, int a, int points, Real* y00, Real* y10, Real* y01, Real* y11) {
  for (int i = 0; i < points; i += lanes<Real>) {
    const Lanes<Real> w0 = load(s.b[a][0] + i) + load(s.right[a][0] + i),
                      wy = load(s.b[a][1] + i) + load(s.right[a][1] + i);
    const Lanes<Real> wz = load(s.b[a][2] + i) + load(s.right[a][2] + i),
                      wyz = load(s.b[a][3] + i) + load(s.right[a][3] + i);
    const Lanes<Real> low_sum = w0 - wz, low_difference = wy - wyz, high_sum = w0 + wz, high_difference = wy + wyz;
    add<Real>(low_sum - low_difference, y00 + i);
    add<Real>(low_sum + low_difference, y10 + i);
    add<Real>(high_sum - high_difference, y01 + i);
    add<Real>(high_sum + high_difference, y11 + i);
  }
}

template <class Real, bool with_pressure, bool with_divergence>
void cells_of(const CellBlocks<Real>& K, const CellRow* rows, long count, const Real* const* u, const Real* fill,
              const Real* p, Real* divergence, const PlanePair<Real>& y) {
  Patterns<Real> s;
  for (const CellRow* row = rows; row != rows + count; ++row) {
    const int n = row->length;
    const Real* w = fill ? fill + row->cell : nullptr;
    for (int a = 0; a < 3; ++a)
      transform_across<Real>({u[a] + row->point[0], u[a] + row->point[1], u[a] + row->point[2], u[a] + row->point[3]},
                             whole_vectors<Real>(n), s.b[a]);
    couple<Real, 0, with_pressure, with_divergence>(K, n, w, with_pressure ? p + row->cell : nullptr,
                                                    with_divergence ? divergence + row->cell : nullptr, s);
    couple<Real, 1, false, false>(K, n, w, nullptr, nullptr, s);
    couple<Real, 2, false, false>(K, n, w, nullptr, nullptr, s);
    couple<Real, 3, false, false>(K, n, w, nullptr, nullptr, s);
    clear_ends(n, s);
    for (int a = 0; a < 3; ++a)
      add_across<Real>(s, a, n + 1, y.low[a] + row->point[0] - y.low_begin, y.low[a] + row->point[1] - y.low_begin,
                       y.high[a] + row->point[2] - y.high_begin, y.high[a] + row->point[3] - y.high_begin);
  }
}

template <class Real>
void cells(const CellBlocks<Real>& K, const CellRow* rows, long count, const Real* const* u, const Real* fill,
           const Real* p, Real* divergence, const PlanePair<Real>& y) {
  if (p)
    cells_of<Real, true, true>(K, rows, count, u, fill, p, divergence, y);
  else if (divergence)
    cells_of<Real, false, true>(K, rows, count, u, fill, nullptr, divergence, y);
  else
    cells_of<Real, false, false>(K, rows, count, u, fill, nullptr, nullptr, y);
}

template <class Real>
void divergence_of(Real gradient, const CellRow* rows, long count, const PlanePair<Real>& u, const Real* fill,
                   Real* divergence) {
  alignas(64) Real along[scratch], across[scratch];  // sums over a point's four rows: u_x, and the terms of u_y and u_z
  for (const CellRow* row = rows; row != rows + count; ++row) {
    const long p00 = row->point[0] - u.low_begin, p10 = row->point[1] - u.low_begin;
    const long p01 = row->point[2] - u.high_begin, p11 = row->point[3] - u.high_begin;
    const int n = row->length, end = whole_vectors<Real>(n);
    for (int i = 0; i <= end; i += lanes<Real>) {
      store<Real>((load(u.low[0] + p00 + i) + load(u.low[0] + p10 + i)) +
                      (load(u.high[0] + p01 + i) + load(u.high[0] + p11 + i)),
                  along + i);
      store<Real>((load(u.low[1] + p10 + i) - load(u.low[1] + p00 + i)) +
                      (load(u.high[1] + p11 + i) - load(u.high[1] + p01 + i)) +
                      (load(u.high[2] + p01 + i) + load(u.high[2] + p11 + i)) -
                      (load(u.low[2] + p00 + i) + load(u.low[2] + p10 + i)),
                  across + i);
    }
    const Real* w = fill ? fill + row->cell : nullptr;
    for (int i = 0; i < n; i += lanes<Real>) {
      const Lanes<Real> sum = load(along + i + 1) - load(along + i) + load(across + i) + load(across + i + 1);
      store<Real>(gradient * fill_at(w, i, n) * sum, divergence + row->cell + i);
    }
  }
}

template <class Real>
void gradient_of(Real gradient, const CellRow* rows, long count, const Real* p, const Real* fill,
                 const PlanePair<Real>& y) {
  alignas(64) Real t[scratch + margin];  // pressures, shifted by one cell and padded with zeros
  for (const CellRow* row = rows; row != rows + count; ++row) {
    const int n = row->length, end = whole_vectors<Real>(n);
    const Real* w = fill ? fill + row->cell : nullptr;
    t[0] = 0;
    for (int i = 0; i < n; i += lanes<Real>)
      store<Real>(gradient * fill_at(w, i, n) * load(p + row->cell + i), t + 1 + i);
    store<Real>(Lanes<Real>(Real(0)), t + 1 + end);
    const long p00 = row->point[0] - y.low_begin, p10 = row->point[1] - y.low_begin;
    const long p01 = row->point[2] - y.high_begin, p11 = row->point[3] - y.high_begin;
    for (int i = 0; i <= n; i += lanes<Real>) {
      const Lanes<Real> left = load(t + i), right = load(t + i + 1), along = left - right, sum = left + right;
      add<Real>(along, y.low[0] + p00 + i);
      add<Real>(along, y.low[0] + p10 + i);
      add<Real>(along, y.high[0] + p01 + i);
      add<Real>(along, y.high[0] + p11 + i);
      add<Real>(-sum, y.low[1] + p00 + i);
      add<Real>(sum, y.low[1] + p10 + i);
      add<Real>(-sum, y.high[1] + p01 + i);
      add<Real>(sum, y.high[1] + p11 + i);
      add<Real>(-sum, y.low[2] + p00 + i);
      add<Real>(-sum, y.low[2] + p10 + i);
      add<Real>(sum, y.high[2] + p01 + i);
      add<Real>(sum, y.high[2] + p11 + i);
    }
  }
}

// Simple enough for the compiler to vectorise.

/// y += a b.
template <class Real>
inline void add_products(int n, const Real* __restrict a, const Real* __restrict b, Real* __restrict y) {
  for (int i = 0; i < n; ++i) y[i] += a[i] * b[i];
}

/// y += c a.
template <class Real>
inline void add_multiple(int n, Real c, const Real* __restrict a, Real* __restrict y) {
  for (int i = 0; i < n; ++i) y[i] += c * a[i];
}

template <class Real>
void inflow(const SpringRun* runs, long count, const Real* directions, const Real* w_i, const Real* w_j,
            const Real* const* u, Real* J) {
  alignas(64) Real e[longest_cell_row];
  for (const SpringRun* run = runs; run != runs + count; ++run) {
    const int n = run->length;
    for (int s = 0; s < n; ++s) e[s] = 0;
    for (int a = 0; a < 3; ++a) {
      const Real d = directions[3 * run->direction + a];
      if (d == 0) continue;
      const Real *from = u[a] + run->i, *to = u[a] + run->j;
      for (int s = 0; s < n; ++s) e[s] += d * (to[s] - from[s]);
    }
    // One end after the other: along x a spring's second point is the next spring's first.
    add_products<Real>(n, w_i + run->spring, e, J + run->i);
    add_products<Real>(n, w_j + run->spring, e, J + run->j);
  }
}

template <class Real>
void outflow(const SpringRun* runs, long count, const Real* directions, const Real* w_i, const Real* w_j, const Real* p,
             Real* const* y) {
  alignas(64) Real t[longest_cell_row];
  for (const SpringRun* run = runs; run != runs + count; ++run) {
    const int n = run->length;
    const Real *at_i = w_i + run->spring, *at_j = w_j + run->spring, *p_i = p + run->i, *p_j = p + run->j;
    for (int s = 0; s < n; ++s) t[s] = at_i[s] * p_i[s] + at_j[s] * p_j[s];
    for (int a = 0; a < 3; ++a) {
      const Real d = directions[3 * run->direction + a];
      if (d == 0) continue;
      add_multiple<Real>(n, -d, t, y[a] + run->i);
      add_multiple<Real>(n, d, t, y[a] + run->j);
    }
  }
}

template <class Real>
void chebyshev(long n, const Real* __restrict y, const Real* __restrict d, Real a, Real b, Real* __restrict r,
               Real* __restrict z, Real* __restrict x) {
  for (long i = 0; i < n; ++i) {
    const Real residual = r[i] - y[i];
    const Real step = a * z[i] + b * d[i] * residual;
    r[i] = residual;
    z[i] = step;
    x[i] += step;
  }
}

template <class Real>
void schur_step(long n, const Real* __restrict y, const Real* __restrict c, const Real* __restrict d, Real a, Real b,
                Real* __restrict r, Real* __restrict z, Real* __restrict x) {
  for (long i = 0; i < n; ++i) {
    const Real residual = r[i] - (y[i] + c[i] * z[i]);
    const Real step = a * z[i] + b * d[i] * residual;
    r[i] = residual;
    z[i] = step;
    x[i] += step;
  }
}

template <class Real>
void restrict_row(int fine_points, bool odd, Real weight, const Real* __restrict fine, Real* __restrict coarse) {
  const Real half = weight / 2;
  int f = 0;  // the fine point that coincides with the next coarse one
  if (odd) {
    coarse[0] += half * fine[0];
    f = 1;
    ++coarse;
    if (fine_points > 1) coarse[0] += half * fine[0];
  }
  if (odd && fine_points == 1) {
    coarse[0] += half * fine[0];
    return;
  }
  const int inner = (fine_points - f - 1) / 2;  // pairs of successive coarse points within the fine row
  const Real* at = fine + f;
  for (int c = 0; c < inner; ++c) coarse[c] += weight * at[2 * c] + half * at[2 * c + 1];
  for (int c = 0; c < inner; ++c) coarse[c + 1] += half * at[2 * c + 1];
  const int last = f + 2 * inner;
  coarse[inner] += weight * fine[last];
  if (last + 1 < fine_points) {
    coarse[inner] += half * fine[last + 1];
    coarse[inner + 1] += half * fine[last + 1];
  }
}

template <class Real>
void prolongate_row(int fine_points, bool odd, Real weight, const Real* const* coarse, int count,
                    Real* __restrict fine) {
  Real sum[longest_cell_row + 4];
  const int coarse_points = (fine_points + odd) / 2 + 1;
  for (int c = 0; c < coarse_points; ++c) sum[c] = weight * coarse[0][c];
  for (int k = 1; k < count; ++k)
    for (int c = 0; c < coarse_points; ++c) sum[c] += weight * coarse[k][c];
  int f = 0;
  const Real* at = sum;
  if (odd) {
    fine[f++] = (sum[0] + sum[1]) / 2;
    ++at;
  }
  const int pairs = (fine_points - f) / 2;
  for (int c = 0; c < pairs; ++c) {
    fine[f + 2 * c] = at[c];
    fine[f + 2 * c + 1] = (at[c] + at[c + 1]) / 2;
  }
  if (f + 2 * pairs < fine_points) fine[f + 2 * pairs] = at[pairs];
}

}  // namespace

template <class Real>
CellKernels<Real> cell_kernels() {
  return {.cells = cells<Real>,
          .divergence = divergence_of<Real>,
          .gradient = gradient_of<Real>,
          .inflow = inflow<Real>,
          .outflow = outflow<Real>,
          .chebyshev = chebyshev<Real>,
          .schur_step = schur_step<Real>,
          .restrict_row = restrict_row<Real>,
          .prolongate_row = prolongate_row<Real>};
}

template CellKernels<double> cell_kernels();
template CellKernels<float> cell_kernels();

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
