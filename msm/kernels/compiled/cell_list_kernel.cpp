// Averaged springs, or the forms of measured cells, of a list of cells.  The signed sums of the corners' displacements
// give F, whatever part of a cell is filled, by four products per entry: mean_gradients() has the same signs.
#include "msm/kernels/compiled/all_kernels.h"

#include "msm/kernels/compiled/listed_cells.h"
#include "msm/kernels/compiled/measured_cells.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {
namespace {

/// w += (hourglass springs) v, and those of the branches' overstrains Z in one go.
template <class Real>
SPRINGPROOF_INLINE void add_hourglass_forces(const CellList<Real>& list, const LatticeAveraged<Lanes<Real>>& law,
                                             const Cells<Real>& c, const Lanes<Real> (&v)[4][3],
                                             const Lanes<Real> (&Z)[4][3], Lanes<Real> (&w)[4][3]) {
  const auto [own, other] = list.bending_of_branches;
  Lanes<Real> H[3][3], of_branches[3][3], last[3];
  in_centroid(c, v, H);
  in_centroid(c, Z, of_branches);
  for (int y = 0; y < 3; ++y) {
    const int z = (y + 1) % 3, x = (y + 2) % 3;
    H[y][y] += of_branches[y][y];
    H[z][x] += own * of_branches[z][x] + other * of_branches[x][z];
    H[x][z] += own * of_branches[x][z] + other * of_branches[z][x];
    last[y] = v[3][y] + Z[3][y];
  }
  add_forces_of_centroid(law, c, H, last, w);
}

constexpr int deviator_of[5][2] = {{0, 0}, {1, 1}, {1, 2}, {2, 0}, {0, 1}};

/// What branches follow (overstrain_count).
template <class Real>
SPRINGPROOF_INLINE void strains_of_branches(const Lanes<Real> (&D)[3][3], const Lanes<Real> (&v)[4][3],
                                            Lanes<Real> (&z)[overstrain_count]) {
  using V = Lanes<Real>;
  const auto twice = [&](int i, int j) -> V {
    return (D[i][j] + D[j][i]) + (D[0][i] * D[0][j] + D[1][i] * D[1][j] + D[2][i] * D[2][j]);
  };
  for (int e = 0; e < 5; ++e) z[e] = twice(deviator_of[e][0], deviator_of[e][1]);
  const V mean = Real(1.0 / 3) * (z[0] + z[1] + twice(2, 2));
  for (int e = 0; e < 2; ++e) z[e] -= mean;
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j) z[5 + 3 * m + j] = v[m][j];
}

template <class Real>
SPRINGPROOF_INLINE void patterns_of(const Lanes<Real> (&Z)[overstrain_count], Lanes<Real> (&of_patterns)[4][3]) {
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j) of_patterns[m][j] = Z[5 + 3 * m + j];
}

/// Sums of the branches' overstrains by their shares, and P of the next step.
/// @tparam count of the branches; 0: any
template <int count, class Real>
SPRINGPROOF_INLINE void relax(const CellList<Real>& list, Real* P, const Lanes<Real> (&z)[overstrain_count],
                              Lanes<Real> (&Z)[overstrain_count]) {
  using V = Lanes<Real>;
  const int branches = count > 0 ? count : list.branch_count;
  Real gain = 0;
  for (int b = 0; b < branches; ++b) gain += list.branches[b].gain;
  for (int e = 0; e < overstrain_count; ++e) {
    Real* of_branch = P + e * lanes<Real>;
    V sum = gain * z[e];
    for (int b = 0; b < branches; ++b, of_branch += overstrain_count * lanes<Real>) {
      prefetch(of_branch + overstrain_count * lanes<Real> * branches);  // of the next vector
      const V before = load(of_branch);
      sum -= list.branches[b].loss * before;
      store<Real>(list.branches[b].decay * before + z[e], of_branch);
    }
    Z[e] = sum;
  }
}

template <class Real>
SPRINGPROOF_INLINE void relax(const CellList<Real>& list, Real* P, const Lanes<Real> (&z)[overstrain_count],
                              Lanes<Real> (&Z)[overstrain_count]) {
  switch (list.branch_count) {
    case 1:
      return relax<1>(list, P, z, Z);
    case 2:
      return relax<2>(list, P, z, Z);
    default:
      return relax<0>(list, P, z, Z);
  }
}

/// Energy over the edge of overstrains Q of a share of 1.
template <class Real>
SPRINGPROOF_INLINE Lanes<Real> energy_of(const LatticeAveraged<Lanes<Real>>& law, const Cells<Real>& c,
                                         const Lanes<Real> (&Q)[overstrain_count]) {
  using V = Lanes<Real>;
  V square = Real(2) * (Q[0] * Q[0] + Q[1] * Q[1] + Q[0] * Q[1]), of_patterns = 0, v[4][3], w[4][3];
  for (int e = 2; e < 5; ++e) square += Real(2) * Q[e] * Q[e];
  patterns_of(Q, v);
  for (auto& of_pattern : w)
    for (V& entry : of_pattern) entry = 0;
  add_hourglass_forces(law, c, v, w);
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j) of_patterns += v[m][j] * w[m][j];
  return Real(0.25) * law.shear * square + Real(0.5) * of_patterns;
}

/// A step of the branches: their stress over the edge, P = G F Z, and w += forces of the hourglass springs of v and Z.
template <class Real>
SPRINGPROOF_INLINE void add_branches(const CellList<Real>& list, Real* overstrains,
                                     const LatticeAveraged<Lanes<Real>>& springs, const Cells<Real>& c,
                                     const Lanes<Real> (&D)[3][3], const Lanes<Real> (&F)[3][3],
                                     const Lanes<Real> (&v)[4][3], Lanes<Real> (&P)[3][3], Lanes<Real> (&w)[4][3]) {
  using V = Lanes<Real>;
  V z[overstrain_count], Z[overstrain_count], of_patterns[4][3], stress[5];
  strains_of_branches<Real>(D, v, z);
  relax(list, overstrains, z, Z);
  const V shear = c.area * list.relaxing.shear;
  for (int e = 0; e < 5; ++e) stress[e] = shear * Z[e];
  const V third = -(stress[0] + stress[1]);
  for (int i = 0; i < 3; ++i) {
    P[i][0] = F[i][0] * stress[0] + F[i][1] * stress[4] + F[i][2] * stress[3];
    P[i][1] = F[i][0] * stress[4] + F[i][1] * stress[1] + F[i][2] * stress[2];
    P[i][2] = F[i][0] * stress[3] + F[i][1] * stress[2] + F[i][2] * third;
  }
  patterns_of(Z, of_patterns);
  add_hourglass_forces(list, springs, c, v, of_patterns, w);
}

/// Of measured cells: y += the branches' Z.
/// @return the mean of the first three of M Z, which branches have not
template <class Real>
SPRINGPROOF_INLINE Lanes<Real> add_branches(const CellList<Real>& list, Real* overstrains, const Real* form,
                                            Lanes<Real> (&y)[18]) {
  Lanes<Real> z[overstrain_count], Z[overstrain_count], of_branches[18];
  shape_of<Real>(y, z);
  relax(list, overstrains, z, Z);
  deformations_of_shape<Real>(Z, of_branches);
  for (int e = 0; e < 18; ++e) y[e] += of_branches[e];
  return Real(1.0 / 3) * trace_of_form<cells<Real>>(form, of_branches);
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
  turned_back(F, S, v);
  for (auto& of_pattern : w)
    for (V& entry : of_pattern) entry = 0;
  const LatticeAveraged<V> springs = times_area(list.springs, c.area);
  constexpr bool measured = curve == LatticeCurve::none;
  Real* overstrains = list.overstrains + overstrain_count * list.branch_count * (cells<Real> * block + at);
  V of_branches[3][3];  // here, where fewest numbers are kept beside them
  if constexpr (relaxing && !measured)
    add_branches(list, overstrains, springs, c, D, F, v, of_branches, w);
  else if constexpr (!measured)
    add_hourglass_forces(springs, c, v, w);
  invert(D, F, inverse_transposed, dilatation);
  if constexpr (curve == LatticeCurve::neo_hooke_isochoric)  // the others have the logarithm of J
    stdx::where(dilatation < Real(-1), dilatation) = Real(__builtin_nan(""));
  V rate[3][3], S_rate[3][4];
  if constexpr (viscous) {
    patterns_of_cells<Real>(rates, at, c, rate, S_rate);
    if (list.boxes) stretch(list, rate, S_rate);
  }
  if constexpr (measured) {
    const Principal<Real> principal(D, dilatation);
    const V edge = Real(1) / c.per_edge;
    const Real* form = list.forms + cell_number::of_form * cells<Real> * block + at;
    V y[18], s[18], volume_of_branches = 0;
    deformations<Real>(principal, edge, v, y);
    if constexpr (relaxing) volume_of_branches = add_branches<Real>(list, overstrains, form, y);
    if constexpr (viscous) {
      turned_back_rates<Real>(F, S, rate, S_rate, v);
      add_rates<Real>(principal, list.retardation * edge, F, rate, v, y);
    }
    times_form<cells<Real>>(form, y, s);
    for (int e = 0; relaxing && e < 3; ++e) s[e] -= volume_of_branches;
    measured_stress<Real>(principal, F, s, P, w);
  } else {
    first_stress<curve>(springs, D, inverse_transposed, dilatation, P);
  }
  if constexpr (relaxing && !measured)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) P[i][j] += of_branches[i][j];
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
void forces(const CellList<Real>& list, const Padded<Real>* u, const Padded<Real>* s, Padded<Real>* f) {
  if (list.branch_count > 0)
    s ? forces_of_curve<true, true>(list, u, s, f) : forces_of_curve<false, true>(list, u, s, f);
  else
    s ? forces_of_curve<true, false>(list, u, s, f) : forces_of_curve<false, false>(list, u, s, f);
}

/// The same of measured cells, of the form at `form`.
template <class Real>
SPRINGPROOF_INLINE Lanes<Real> energy_of(const Real* form, const Lanes<Real> (&Q)[overstrain_count]) {
  Lanes<Real> y[18], s[18], sum = 0;
  deformations_of_shape<Real>(Q, y);
  times_form<cells<Real>>(form, y, s);
  for (int e = 0; e < 18; ++e) sum += y[e] * s[e];
  return Real(0.5) * sum;
}

/// Adds the energies of the branches of a vector of cells.
template <bool measured, class Real>
SPRINGPROOF_INLINE void add_branch_energies(const CellList<Real>& list, long block, int at, const Corners<Real>& u,
                                            double* stored) {
  using V = Lanes<Real>;
  const Cells<Real> c(list.numbers + cell_number::count * cells<Real> * block + at);
  V D[3][3], S[3][4], F[3][3], v[4][3], z[overstrain_count], Q[overstrain_count], energy;
  patterns_of_cells<Real>(u, at, c, D, S);
  if (list.boxes) stretch(list, D, S);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) F[i][j] = i == j ? D[i][j] + Real(1) : D[i][j];
  turned_back(F, S, v);
  if constexpr (measured) {
    V inverse_transposed[3][3], dilatation, y[18];
    invert(D, F, inverse_transposed, dilatation);
    deformations<Real>(Principal<Real>(D, dilatation), Real(1) / c.per_edge, v, y);
    shape_of<Real>(y, z);
  } else {
    strains_of_branches<Real>(D, v, z);
  }
  const Real* P = list.overstrains + overstrain_count * list.branch_count * (cells<Real> * block + at);
  for (int b = 0; b < list.branch_count; ++b) {
    for (int e = 0; e < overstrain_count; ++e, P += lanes<Real>)
      Q[e] = list.branches[b].gain * z[e] - list.branches[b].loss * load(P);
    if constexpr (measured)
      energy = energy_of<Real>(list.forms + cell_number::of_form * cells<Real> * block + at, Q);
    else
      energy = energy_of(times_area(list.relaxing, c.area), c, Q) / c.per_edge;
    alignas(64) Real of_cells[lanes<Real>];
    store<Real>(energy / list.branches[b].share, of_cells);
    for (const Real of_cell : of_cells) stored[b] += double(of_cell);
  }
}

template <bool measured, class Real>
void energies_of_list(const CellList<Real>& list, const Padded<Real>* u, double* stored) {
  alignas(64) Corners<Real> at;
  for (long b = 0; b < list.blocks; ++b) {
    const int* places = list.corners + 8 * cells<Real> * b;
    for (int n = 0; n < 8; ++n) gather<3>(u, places + n * cells<Real>, at[n]);
    for (int lane = 0; lane < cells<Real>; lane += lanes<Real>)
      add_branch_energies<measured, Real>(list, b, lane, at, stored);
  }
}

template <class Real>
void branch_energies(const CellList<Real>& list, const Padded<Real>* u, double* stored) {
  list.springs.curve == LatticeCurve::none ? energies_of_list<true>(list, u, stored)
                                           : energies_of_list<false>(list, u, stored);
}

}  // namespace

template <class Real>
CellListKernels<Real> cell_list_kernels() {
  return {.cells = cells<Real>, .lanes = lanes<Real>, .forces = forces<Real>, .branch_energies = branch_energies<Real>};
}

template CellListKernels<double> cell_list_kernels();
template CellListKernels<float> cell_list_kernels();

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
