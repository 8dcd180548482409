// A vector of cells of a list, which the body may fill in part: gradient and patterns of their corners, hourglass
// springs.
#pragma once

#include "msm/kernels/compiled/averaged_cells.h"
#include "msm/kernels/compiled/padded_nodes.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

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

constexpr int to_centroid = 4;  // mean / 2, of twice the second differences

/// Components of the patterns in the centroid of the filled part.
template <class Real>
SPRINGPROOF_INLINE void in_centroid(const Cells<Real>& c, const Lanes<Real> (&v)[4][3], Lanes<Real> (&H)[3][3]) {
  for (int j = 0; j < 3; ++j) {
    const Lanes<Real> third = Real(to_centroid) * v[3][j];
    for (int m = 0; m < 3; ++m) H[m][j] = v[m][j] + c.mean[m] * third;
  }
}

/// w += forces of hourglass springs of H and of the last pattern's components.
template <class Real>
SPRINGPROOF_INLINE void add_forces_of_centroid(const LatticeAveraged<Lanes<Real>>& law, const Cells<Real>& c,
                                               const Lanes<Real> (&H)[3][3], const Lanes<Real> (&last)[3],
                                               Lanes<Real> (&w)[4][3]) {
  using V = Lanes<Real>;
  const V* const rho = c.variance;
  V added[3][3];
  for (int y = 0; y < 3; ++y) {
    const int z = (y + 1) % 3, x = (y + 2) % 3;
    const V bending = rho[y] * law.bending, coupling = rho[y] * law.coupling, sides = rho[z] + rho[x];
    added[z][x] = bending * H[z][x] + coupling * H[x][z];
    added[x][z] = bending * H[x][z] + coupling * H[z][x];
    added[y][y] = law.torsion * (sides * H[y][y] + rho[z] * H[x][x] + rho[x] * H[z][z]) +
                  (Real(0.5) * law.twist) * sides * H[y][y];
    const V warping = Real(0.3 / 2.3) * rho[z] * rho[x] + Real(1 / 2.3) * rho[y] * sides;
    w[3][y] += law.warping * warping * last[y];
  }
  for (int j = 0; j < 3; ++j) {
    V turned = 0;
    for (int m = 0; m < 3; ++m) {
      w[m][j] += added[m][j];
      turned += c.mean[m] * added[m][j];
    }
    w[3][j] += Real(to_centroid) * turned;
  }
}

/// w += (hourglass springs) v: AveragedSprings::add_forces() in sums over the corners.
template <class Real>
SPRINGPROOF_INLINE void add_hourglass_forces(const LatticeAveraged<Lanes<Real>>& law, const Cells<Real>& c,
                                             const Lanes<Real> (&v)[4][3], Lanes<Real> (&w)[4][3]) {
  Lanes<Real> H[3][3];
  in_centroid(c, v, H);
  add_forces_of_centroid(law, c, H, v[3], w);
}

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
