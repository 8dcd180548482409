// A sweep over the cells and nodes of a lattice, as a GPU makes it: a block of threads climbs through the planes, each
// thread with a column of cells and the column of nodes at their lower corner.  Every cell is computed once per block;
// what it gives to the corners of neighbouring columns passes through shared memory, and what it gives to its upper
// corners waits in the thread for the next plane.
#pragma once

#include "msm/gpu/backend.h"
#include "msm/gpu/gpu.h"
#include "msm/kernels/compiled/averaged_cells.h"

namespace springproof::gpu {

/// Law: `bool present(int at)` of the cell whose lowest corner is there, and `derivative(at, along, S, A, B)`, which
/// gives the derivative of the cell's energy by the sums of signed_sums(), for each of three components.
/// Finish: `void operator()(int at, const Real (&derivative)[3], double (&sums)[sums_of_launch])` of each node's place.
template <class Real, class Law, class Finish>
struct Sweep {
  static constexpr bool exchanges = Law::has_cells;
  static constexpr int blocks_at_once = Law::has_cells ? 2 : 4;  ///< that a multiprocessor must have registers for

  struct Thread {
    Real d[3][2], m[3][2];  ///< of the plane below: differences and sums along x, of rows y and y + 1
    Real upper[4][3];       ///< what the cell below gives to its upper corners
    Real own[3];            ///< of the node, from this thread's cells
    double sums[sums_of_launch];
  };
  using Shared = Real[3][3][tile_y][tile_x];  ///< to the nodes at (x + 1, y), (x, y + 1), (x + 1, y + 1)

  Box box;
  const Real* u[3];
  Law law;
  Finish finish;
  double* partial;  ///< sums of each block; null: not wanted

  SPRINGPROOF_INLINE int first_plane(const ThreadPlace& p) const { return 1 + p.block[2] * box.planes_of_block; }
  SPRINGPROOF_INLINE int end_plane(const ThreadPlace& p) const {
    const int end = first_plane(p) + box.planes_of_block;
    return end < box.nodes[2] + 1 ? end : box.nodes[2] + 1;
  }
  SPRINGPROOF_INLINE int column(const ThreadPlace& p) const {
    return (p.block[0] * Box::own_x + p.lane) + box.row * (p.block[1] * Box::own_y + p.line);
  }

  SPRINGPROOF_INLINE void start(const ThreadPlace& p, Thread& t) const {
    for (double& sum : t.sums) sum = 0;
    if constexpr (Law::has_cells) {
      const int at = column(p) + box.plane * (first_plane(p) - 1);
      for (int i = 0; i < 3; ++i) edges_along_x(u[i] + at, t.d[i], t.m[i]);
      for (auto& corner : t.upper)
        for (Real& value : corner) value = 0;
    }
  }

  /// The cells between planes z and z + 1.
  SPRINGPROOF_INLINE void cells(const ThreadPlace& p, int z, Thread& t, Shared& shared) const {
    if constexpr (Law::has_cells) {
      const int at = column(p) + box.plane * z;
      Real along[3][3], S[3][4], total[4][3];
      for (int i = 0; i < 3; ++i) {
        Real d[4] = {t.d[i][0], t.d[i][1]}, m[4] = {t.m[i][0], t.m[i][1]};
        edges_along_x(u[i] + at + box.plane, t.d[i], t.m[i]);
        d[2] = t.d[i][0], d[3] = t.d[i][1], m[2] = t.m[i][0], m[3] = t.m[i][1];
        signed_sums<Real>(d, m, along[i], S[i]);
      }
      for (int corner = 0; corner < 4; ++corner)
        for (int i = 0; i < 3; ++i) total[corner][i] = t.upper[corner][i], t.upper[corner][i] = 0;
      if (law.present(at)) {
        Real A[3][3], B[3][4];
        law.derivative(at, along, S, A, B);
        for (int i = 0; i < 3; ++i) {
          Real even[4], odd[4];
          at_corners<Real>(A[i], B[i], even, odd);
          for (int y = 0; y < 2; ++y) {
            total[2 * y][i] += even[y] - odd[y];
            total[2 * y + 1][i] += even[y] + odd[y];
            t.upper[2 * y][i] = even[2 + y] - odd[2 + y];
            t.upper[2 * y + 1][i] = even[2 + y] + odd[2 + y];
          }
        }
      }
      for (int i = 0; i < 3; ++i) {
        t.own[i] = total[0][i];
        for (int corner = 1; corner < 4; ++corner) shared[corner - 1][i][p.line][p.lane] = total[corner][i];
      }
    }
  }

  /// The nodes of plane z, once all threads of the block have done the cells above it.
  SPRINGPROOF_INLINE void nodes(const ThreadPlace& p, int z, Thread& t, const Shared& shared) const {
    if (p.lane == 0 || p.line == 0 || z < first_plane(p)) return;
    Real derivative[3] = {};
    if constexpr (Law::has_cells)
      for (int i = 0; i < 3; ++i)
        derivative[i] = t.own[i] + shared[0][i][p.line][p.lane - 1] + shared[1][i][p.line - 1][p.lane] +
                        shared[2][i][p.line - 1][p.lane - 1];
    finish(column(p) + box.plane * z, derivative, t.sums);
  }

 private:
  SPRINGPROOF_INLINE void edges_along_x(const Real* at, Real (&d)[2], Real (&m)[2]) const {
    for (int y = 0; y < 2; ++y) {
      const Real low = at[y * box.row], high = at[y * box.row + 1];
      d[y] = high - low;
      m[y] = high + low;
    }
  }
};

/// The derivative in no cells: springs alone.
struct NoCells {
  static constexpr bool has_cells = false;
};

}  // namespace springproof::gpu
