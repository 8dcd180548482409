// Averaged springs, or the forms of measured cells, of a list of cells.  The signed sums of the corners' displacements
// give F, whatever part of a cell is filled, by four products per entry: mean_gradients() has the same signs.
#include "msm/kernels/compiled/all_kernels.h"

#include "msm/kernels/compiled/averaged_cells.h"
#include "msm/kernels/compiled/padded_nodes.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {
namespace {

template <class Real>
constexpr int cells = 4 * group<Real>;  // of a block

/// Displacements of the corners of a block of cells, which become the forces on them; the fourth component is
/// velocity / s.
template <class Real>
using Corners = Real[8][4][cells<Real>];

/// What is stored of a vector of cells.
template <class Real>
struct Cells {
  Lanes<Real> area, mean[3], mixed[3], variance[3], per_edge;

  SPRINGPROOF_INLINE explicit Cells(const Real* numbers)
      : area(load(numbers)), per_edge(load(numbers + cell_number::per_edge * cells<Real>)) {
    for (int i = 0; i < 3; ++i) {
      mean[i] = load(numbers + (cell_number::mean + i) * cells<Real>);
      mixed[i] = load(numbers + (cell_number::mixed + i) * cells<Real>);
      variance[i] = load(numbers + (cell_number::variance + i) * cells<Real>);
    }
  }
};

/// D, the mean gradient, and the patterns S (yz, zx, xy, xyz) of the field at the corners, over the edge.
template <class Real>
SPRINGPROOF_INLINE void patterns_of_cells(const Corners<Real>& u, int at, const Cells<Real>& c, Lanes<Real> (&D)[3][3],
                                          Lanes<Real> (&S)[3][4]) {
  using V = Lanes<Real>;
  const V quarter = Real(0.25) * c.per_edge;
  for (int i = 0; i < 3; ++i) {
    V d[4], m[4], along[3];
    for (int k = 0; k < 4; ++k) {
      const V low = load(&u[2 * k][i][at]), high = load(&u[2 * k + 1][i][at]);
      d[k] = high - low;
      m[k] = high + low;
    }
    signed_sums(d, m, along, S[i]);
    for (V& pattern : S[i]) pattern *= c.per_edge;
    for (int x = 0; x < 3; ++x) {
      const int y = (x + 1) % 3, z = (x + 2) % 3;
      D[i][x] = quarter * along[x] + c.mean[y] * S[i][z] + c.mean[z] * S[i][y] + c.mixed[x] * S[i][3];
    }
  }
}

/// From a cube of the same volume to a box: D per length along its edges, S as H_pq / (p_p p_q) (AveragedSprings).
template <class Real>
SPRINGPROOF_INLINE void stretch(const CellList<Real>& list, Lanes<Real> (&D)[3][3], Lanes<Real> (&S)[3][4]) {
  for (int i = 0; i < 3; ++i)
    for (int a = 0; a < 3; ++a) {
      D[i][a] *= list.per_proportion[a];
      S[i][a] *= list.proportions[a];
    }
}

/// Those of a law times the volume over the edge of each cell.
template <class Real>
SPRINGPROOF_INLINE LatticeAveraged<Lanes<Real>> times_area(const LatticeAveraged<Real>& law, const Lanes<Real>& a) {
  return {law.curve,        a * law.shear,   a * law.lambda, a * law.bulk,   a * law.bending,
          a * law.coupling, a * law.torsion, a * law.twist,  a * law.warping};
}

/// w += (hourglass springs) v, in the centroid of the filled part: AveragedSprings::add_forces() in sums over the
/// corners.
template <class Real>
SPRINGPROOF_INLINE void add_hourglass_forces(const LatticeAveraged<Lanes<Real>>& law, const Cells<Real>& c,
                                             const Lanes<Real> (&v)[4][3], Lanes<Real> (&w)[4][3]) {
  using V = Lanes<Real>;
  const V* const rho = c.variance;
  V H[3][3], added[3][3];
  constexpr Real shift = 4;  // mean / 2 to the centroid, of twice the second differences
  for (int j = 0; j < 3; ++j) {
    const V third = shift * v[3][j];
    for (int m = 0; m < 3; ++m) H[m][j] = v[m][j] + c.mean[m] * third;
  }
  for (int y = 0; y < 3; ++y) {
    const int z = (y + 1) % 3, x = (y + 2) % 3;
    const V bending = rho[y] * law.bending, coupling = rho[y] * law.coupling, sides = rho[z] + rho[x];
    added[z][x] = bending * H[z][x] + coupling * H[x][z];
    added[x][z] = bending * H[x][z] + coupling * H[z][x];
    added[y][y] = law.torsion * (sides * H[y][y] + rho[z] * H[x][x] + rho[x] * H[z][z]) +
                  (Real(0.5) * law.twist) * sides * H[y][y];
    const V warping = Real(0.3 / 2.3) * rho[z] * rho[x] + Real(1 / 2.3) * rho[y] * sides;
    w[3][y] += law.warping * warping * v[3][y];
  }
  for (int j = 0; j < 3; ++j) {
    V turned = 0;
    for (int m = 0; m < 3; ++m) {
      w[m][j] += added[m][j];
      turned += c.mean[m] * added[m][j];
    }
    w[3][j] += shift * turned;
  }
}

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

/// s = M y, M by its lower triangle.
template <class Real>
SPRINGPROOF_INLINE void times_form(const Real* form, const Lanes<Real> (&y)[18], Lanes<Real> (&s)[18]) {
  for (int i = 0; i < 18; ++i) {
    Lanes<Real> sum = 0;
    for (int j = 0; j < i; ++j, form += cells<Real>) {
      const Lanes<Real> M = load(form);
      sum += M * y[j];
      s[j] += M * y[i];
    }
    s[i] = sum + load(form) * y[i];
    form += cells<Real>;
  }
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

/// P = dW/dF over the edge, and w of the patterns over their norm, of s = dW/dy.
template <class Real>
SPRINGPROOF_INLINE void measured_stress(const Principal<Real>& at, const Lanes<Real> (&F)[3][3],
                                        const Lanes<Real> (&s)[18], Lanes<Real> (&P)[3][3], Lanes<Real> (&w)[4][3]) {
  using V = Lanes<Real>;
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j) w[m][j] = norm_of_pattern<Real>(m) * s[6 + 3 * m + j];
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

/// Sums of the branches' overstrains by their shares, of twice the strain (entries strain_of) and of v, which P of the
/// next step takes from these.
template <class Real>
SPRINGPROOF_INLINE void relax(const CellList<Real>& list, Real* P, const Lanes<Real> (&D)[3][3],
                              const Lanes<Real> (&v)[4][3], Lanes<Real> (&Z)[overstrain_count]) {
  using V = Lanes<Real>;
  V z[overstrain_count];
  for (int e = 0; e < 6; ++e) {
    const int i = strain_of[e][0], j = strain_of[e][1];
    z[e] = (D[i][j] + D[j][i]) + (D[0][i] * D[0][j] + D[1][i] * D[1][j] + D[2][i] * D[2][j]);
  }
  const V mean = Real(1.0 / 3) * (z[0] + z[1] + z[2]);
  for (int e = 0; e < 3; ++e) z[e] -= mean;
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j) z[6 + 3 * m + j] = v[m][j];
  for (V& sum : Z) sum = 0;
  for (int b = 0; b < list.branch_count; ++b) {
    const auto [share, decay, phi] = list.branches[b];
    for (int e = 0; e < overstrain_count; ++e, P += cells<Real>) {
      const V now = phi * z[e], Q = load(P) + now;
      Z[e] += share * Q;
      store<Real>(decay * Q - now, P);
    }
  }
}

/// P += G F Z, w += (hourglass springs) Z.
template <class Real>
SPRINGPROOF_INLINE void add_relaxing_stress(const LatticeAveraged<Lanes<Real>>& law, const Cells<Real>& c,
                                            const Lanes<Real> (&F)[3][3], const Lanes<Real> (&Z)[overstrain_count],
                                            Lanes<Real> (&P)[3][3], Lanes<Real> (&w)[4][3]) {
  for (int i = 0; i < 3; ++i) {
    P[i][0] += law.shear * (F[i][0] * Z[0] + F[i][1] * Z[5] + F[i][2] * Z[4]);
    P[i][1] += law.shear * (F[i][0] * Z[5] + F[i][1] * Z[1] + F[i][2] * Z[3]);
    P[i][2] += law.shear * (F[i][0] * Z[4] + F[i][1] * Z[3] + F[i][2] * Z[2]);
  }
  Lanes<Real> of_patterns[4][3];
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j) of_patterns[m][j] = Z[6 + 3 * m + j];
  add_hourglass_forces(law, c, of_patterns, w);
}

/// Forces of a vector of cells, the lanes from `at` of their block; `rates`: velocities of the corners.
template <LatticeCurve curve, bool viscous, bool relaxing, class Real>
SPRINGPROOF_INLINE void forces_of_cells(const CellList<Real>& list, long block, int at, Corners<Real>& u,
                                        const Corners<Real>& rates) {
  using V = Lanes<Real>;
  const Cells<Real> c(list.numbers + cell_number::count * cells<Real> * block + at);
  V D[3][3], S[3][4], F[3][3], inverse_transposed[3][3], dilatation, P[3][3], v[4][3], w[4][3];
  patterns_of_cells<Real>(u, at, c, D, S);
  if (list.boxes) stretch(list, D, S);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) F[i][j] = i == j ? D[i][j] + Real(1) : D[i][j];
  invert(D, F, inverse_transposed, dilatation);
  if constexpr (curve == LatticeCurve::neo_hooke_isochoric)  // the others have the logarithm of J
    stdx::where(dilatation < Real(-1), dilatation) = Real(__builtin_nan(""));
  for (auto& of_pattern : w)
    for (V& entry : of_pattern) entry = 0;
  turned_back(F, S, v);
  V Z[overstrain_count];
  if constexpr (relaxing)
    relax(list, list.overstrains + overstrain_count * cells<Real> * list.branch_count * block + at, D, v, Z);
  constexpr bool measured = curve == LatticeCurve::none;
  V rate[3][3], S_rate[3][4];
  if constexpr (viscous) {
    patterns_of_cells<Real>(rates, at, c, rate, S_rate);
    if (list.boxes) stretch(list, rate, S_rate);
  }
  if constexpr (measured) {
    const Principal<Real> principal(D, dilatation);
    const V edge = Real(1) / c.per_edge;
    V y[18], s[18];
    deformations<Real>(principal, edge, v, y);
    if constexpr (viscous) {
      turned_back_rates<Real>(F, S, rate, S_rate, v);
      add_rates<Real>(principal, list.retardation * edge, F, rate, v, y);
    }
    times_form<Real>(list.forms + cell_number::of_form * cells<Real> * block + at, y, s);
    measured_stress<Real>(principal, F, s, P, w);
  } else {
    const LatticeAveraged<V> springs = times_area(list.springs, c.area);
    add_hourglass_forces(springs, c, v, w);
    first_stress<curve>(springs, D, inverse_transposed, dilatation, P);
  }
  if constexpr (relaxing) add_relaxing_stress<Real>(times_area(list.relaxing, c.area), c, F, Z, P, w);
  if constexpr (viscous && !measured) {
    const LatticeAveraged<V> dashpots = times_area(list.dashpots, c.area);
    add_viscous_stress(dashpots, F, inverse_transposed, rate, P);
    turned_back_rates<Real>(F, S, rate, S_rate, v);
    add_hourglass_forces(dashpots, c, v, w);
  }
  constexpr Real quarter = 0.25;
  for (int i = 0; i < 3; ++i) {
    V A[3], B[4], even[4], odd[4];
    for (int j = 0; j < 3; ++j)
      A[j] = P[i][j] + (S[i][0] * w[0][j] + S[i][1] * w[1][j]) + (S[i][2] * w[2][j] + S[i][3] * w[3][j]);
    for (int m = 0; m < 4; ++m) B[m] = F[i][0] * w[m][0] + F[i][1] * w[m][1] + F[i][2] * w[m][2];
    if (list.boxes)
      for (int a = 0; a < 3; ++a) {
        A[a] *= list.per_proportion[a];
        B[a] *= list.proportions[a];
      }
    for (int x = 0; x < 3; ++x) {
      const int y = (x + 1) % 3, z = (x + 2) % 3;
      B[x] += c.mean[y] * A[z] + c.mean[z] * A[y];
      B[3] += c.mixed[x] * A[x];
    }
    for (V& along : A) along *= quarter;
    at_corners(A, B, even, odd);
    for (int k = 0; k < 4; ++k) {
      store<Real>(odd[k] - even[k], &u[2 * k][i][at]);
      store<Real>(-(even[k] + odd[k]), &u[2 * k + 1][i][at]);
    }
  }
}

template <LatticeCurve curve, bool viscous, bool relaxing, class Real>
void forces_of_list(const CellList<Real>& list, const Padded<Real>* u, const Padded<Real>* s, Padded<Real>* f) {
  alignas(64) Corners<Real> at, rates;
  for (long b = 0; b < list.blocks; ++b) {
    const int* places = list.corners + 8 * cells<Real> * b;
    for (int n = 0; n < 8; ++n) {
      gather<viscous ? 4 : 3>(u, places + n * cells<Real>, at[n]);
      if constexpr (viscous) {
        gather<3>(s, places + n * cells<Real>, rates[n]);
        for (int i = 0; i < 3; ++i) wide(rates[n][i]) *= wide(at[n][3]);
      }
    }
    for (int lane = 0; lane < cells<Real>; lane += lanes<Real>)
      forces_of_cells<curve, viscous, relaxing>(list, b, lane, at, rates);
    for (int n = 0; n < 8; ++n) scatter(at[n], places + n * cells<Real>, f);
  }
}

template <bool viscous, bool relaxing, class Real>
void forces_of_curve(const CellList<Real>& list, const Padded<Real>* u, const Padded<Real>* s, Padded<Real>* f) {
  switch (list.springs.curve) {
    case LatticeCurve::hencky:
      return forces_of_list<LatticeCurve::hencky, viscous, relaxing>(list, u, s, f);
    case LatticeCurve::neo_hooke:
      return forces_of_list<LatticeCurve::neo_hooke, viscous, relaxing>(list, u, s, f);
    case LatticeCurve::neo_hooke_isochoric:
      return forces_of_list<LatticeCurve::neo_hooke_isochoric, viscous, relaxing>(list, u, s, f);
    case LatticeCurve::none:
      return forces_of_list<LatticeCurve::none, viscous, relaxing>(list, u, s, f);
  }
}

template <class Real>
void forces(const CellList<Real>& list, const Padded<Real>* u, Padded<Real>* f) {
  forces_of_curve<false, false>(list, u, static_cast<const Padded<Real>*>(nullptr), f);
}

template <class Real>
void relaxing_forces(const CellList<Real>& list, const Padded<Real>* u, const Padded<Real>* s, Padded<Real>* f) {
  s ? forces_of_curve<true, true>(list, u, s, f) : forces_of_curve<false, true>(list, u, s, f);
}

}  // namespace

template <class Real>
CellListKernels<Real> cell_list_kernels() {
  return {.cells = cells<Real>,
          .forces = forces<Real>,
          .viscous_forces = forces_of_curve<true, false, Real>,
          .relaxing_forces = relaxing_forces<Real>};
}

template CellListKernels<double> cell_list_kernels();
template CellListKernels<float> cell_list_kernels();

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
