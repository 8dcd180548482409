// Forces of lattice models and explicit steps, per cell and per node, for sweeps (msm/gpu/sweep.h).
//
// Lengths in cell edges.  Nodes with the same springs and cell share an entry of a table, and so do those with the same
// mass and load.
#pragma once

#include "msm/gpu/gpu.h"
#include "msm/gpu/sweep.h"
#include "msm/kernels/compiled/averaged_cells.h"

namespace springproof::gpu {

/// A lattice model in the device's memory.
template <class Real>
struct LatticeOnGpu {
  Box box;
  const int* kind;    ///< per place: start of its entry
  const Real* kinds;  ///< entries
  const int* load;    ///< per place, or no_node
  const Real* loads;
  bool volume, bounded, corrected;
  LatticeHourglass<Real> hourglass;
  LatticeAveraged<Real> averaged;
};

template <class Real>
struct CellOfKind {
  static constexpr bool has_cells = true;
  const int* kind;
  const Real* kinds;
  SPRINGPROOF_INLINE bool present(int at) const { return kinds[kind[at] + cell_of_kind] != Real(0); }
};

/// Volume and hourglass correction.
template <class Real>
struct CorrectedCells : CellOfKind<Real> {
  bool volume, bounded, corrected;
  LatticeHourglass<Real> k;

  SPRINGPROOF_INLINE void derivative(int at, const Real (&along)[3][3], const Real (&S)[3][4], Real (&A)[3][3],
                                     Real (&B)[3][4]) const {
    for (int i = 0; i < 3; ++i) {
      for (Real& value : A[i]) value = 0;
      for (Real& value : B[i]) value = 0;
    }
    if (volume) {
      Real e[3][3];  // row: four times a mean edge
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) e[j][i] = along[i][j] + (i == j ? Real(4) : Real(0));
      Real area[3][3];
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          const Real(&p)[3] = e[(j + 1) % 3], (&q)[3] = e[(j + 2) % 3];
          area[j][i] = p[(i + 1) % 3] * q[(i + 2) % 3] - p[(i + 2) % 3] * q[(i + 1) % 3];
        }
      const Real J = Real(1.0 / 64) * (e[0][0] * area[0][0] + e[0][1] * area[0][1] + e[0][2] * area[0][2]);
      const Real kappa = this->kinds[this->kind[at] + kappa_of_kind];
      const Real p =
          Real(1.0 / 64) * kappa * (bounded ? pressure<true, Real>(J, kappa) : pressure<false, Real>(J, kappa));
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) A[i][j] = p * area[j][i];
    }
    if (corrected) {
      const Real twisted = k.torsion_coupling * (S[0][0] + S[1][1] + S[2][2]);
      for (int i = 0; i < 3; ++i) {
        B[i][i] = k.torsion * S[i][i] + twisted;
        for (int j = 1; j < 3; ++j) {  // a bending mode, and the one that shares its neutral plane
          const int m = (i + j) % 3;
          B[i][m] = k.bending * S[i][m] + k.coupling * S[m][i];
        }
      }
    }
  }
};

/// Averaged springs.
template <LatticeCurve curve, class Real>
struct AveragedCells : CellOfKind<Real> {
  LatticeAveraged<Real> law;

  SPRINGPROOF_INLINE void derivative(int, const Real (&along)[3][3], const Real (&S)[3][4], Real (&A)[3][3],
                                     Real (&B)[3][4]) const {
    Real D[3][3], F[3][3], inverse_transposed[3][3], dilatation, P[3][3], v[4][3], w[4][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        D[i][j] = Real(0.25) * along[i][j];
        F[i][j] = i == j ? D[i][j] + Real(1) : D[i][j];
      }
    invert<Real>(D, F, inverse_transposed, dilatation);
    for (auto& of_pattern : w)
      for (Real& entry : of_pattern) entry = 0;
    turned_back<Real>(F, S, v);
    add_hourglass_forces<Real>(law, v, w);
    first_stress<curve, Real>(law, D, inverse_transposed, dilatation, P);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        A[i][j] =
            Real(0.25) * (P[i][j] + (S[i][0] * w[0][j] + S[i][1] * w[1][j]) + (S[i][2] * w[2][j] + S[i][3] * w[3][j]));
      for (int m = 0; m < 4; ++m) B[i][m] = F[i][0] * w[m][0] + F[i][1] * w[m][1] + F[i][2] * w[m][2];
    }
  }
};

/// What becomes of a node: its springs are added; then it moves, or its internal force is stored.
/// reach: squared length of the longest springs, 2 or 3; 0: there are none.
template <class Real, int reach>
struct MoveNode {
  LatticeOnGpu<Real> l;
  const Real* u[3];
  Real* moved[3];  ///< the other displacements: those of the neighbours are still read
  Real* v[3];
  Real* force[3];  ///< null: move
  Real time_step, decay;
  bool measure;

  SPRINGPROOF_INLINE void operator()(int at, const Real (&derivative)[3], double (&sums)[sums_of_launch]) const {
    const int load = l.load[at];
    if (load == no_node) return;
    Real f[3] = {-derivative[0], -derivative[1], -derivative[2]};
    if constexpr (reach > 0) add_springs(at, f);
    if (force[0]) {
      for (int i = 0; i < 3; ++i) force[i][at] = f[i];
      return;
    }
    const Real* of_node = l.loads + load;
    for (int i = 0; i < 3; ++i) {
      const Real inverse_mass = of_node[i], sum = f[i] + of_node[3 + i];
      if (measure) {
        const double square = double(sum) * double(sum);
        sums[0] += inverse_mass != Real(0) ? square : 0;
        sums[1] += inverse_mass != Real(0) ? 0 : square;
      }
      const Real speed = (v[i][at] + (time_step * inverse_mass) * sum) * decay;
      v[i][at] = speed;
      moved[i][at] = u[i][at] + time_step * speed;
    }
  }

 private:
  SPRINGPROOF_INLINE void add_springs(int at, Real (&f)[3]) const {
    const Real* k = l.kinds + l.kind[at];
    const Real here[3] = {u[0][at], u[1][at], u[2][at]};
    SPRINGPROOF_UNROLL
    for (int c = 0; c < neighbours; ++c) {
      const int x = c % 3 - 1, y = c / 3 % 3 - 1, z = c / 9 - 1, square = x * x + y * y + z * z;
      if (square == 0 || square > reach) continue;
      const int there = at + x + y * l.box.row + z * l.box.plane;
      const Real d[3] = {u[0][there] - here[0] + Real(x), u[1][there] - here[1] + Real(y),
                         u[2][there] - here[2] + Real(z)};
      const Real length = Real(square == 1 ? 1.0 : square == 2 ? 1.41421356237309504880 : 1.73205080756887729353);
      // A place without a node may be where this one is: no spring, whatever its length.
      const Real t =
          k[c] == Real(0) ? Real(0) : k[c] - k[c] * (length * inverse_root(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
      for (int i = 0; i < 3; ++i) f[i] += t * d[i];
    }
  }
};

}  // namespace springproof::gpu
