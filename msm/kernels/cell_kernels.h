// Matrix-free kernels for lattices of equal cells: stiffness, divergence and gradient, row by row.
#pragma once

namespace springproof {

/// Maximum number of cells in one row of a kernel, so that its intermediate values stay in the first-level cache.
inline constexpr int longest_cell_row = 64;

/// Number of values beyond the end of an array that kernels may read, and add zero to.
inline constexpr int array_slack = 96;

/// A run of cells along x and the numbers of its corner points.
struct CellRow {
  long cell = 0;       ///< number of its first cell
  long point[4] = {};  ///< numbers of the first point of rows (y, z), (y+1, z), (y, z+1), (y+1, z+1)
  int length = 0;
};

/// A run of parallel springs, from a row of points to a row of points.
struct SpringRun {
  long i = 0, j = 0;  ///< points of its first spring; consecutive springs have consecutive points
  long spring = 0;    ///< number of its first spring
  int length = 0;     ///< at most longest_cell_row
  int direction = 0;
};

/// A cell's stiffness in the basis of sign patterns of its corners.  In a cell with three mirror planes component a of
/// pattern t xor e_a (e_a: the sign changes along a) couples only with the two others of the same class t: eight
/// symmetric 3x3 blocks.
template <class Real>
struct CellBlocks {
  Real m[8][6] = {};  ///< per class: xx, xy, xz, yy, yz, zz
  Real gradient = 0;  ///< |dV/du| of a corner, the same for all corners and components
};

/// The two planes of points below and above a plane of cells; each array begins with the plane's first point.
template <class Real>
struct PlanePair {
  Real* low[3] = {};
  Real* high[3] = {};
  long low_begin = 0, high_begin = 0;  ///< numbers of these first points
};

/// Kernels of one instruction set.  The points of a row are contiguous in memory, and so are its cells.
template <class Real>
struct CellKernels {
  /// y += fill (K u + gradient^T p), divergence = fill gradient u.  `fill`, `p`, `divergence` may be null: 1, 0, not
  /// computed.
  void (*cells)(const CellBlocks<Real>& K, const CellRow* rows, long count, const Real* const* u, const Real* fill,
                const Real* p, Real* divergence, const PlanePair<Real>& y);
  /// divergence = fill gradient u.
  void (*divergence)(Real gradient, const CellRow* rows, long count, const PlanePair<Real>& u, const Real* fill,
                     Real* divergence);
  /// y += fill gradient^T p.
  void (*gradient)(Real gradient, const CellRow* rows, long count, const Real* p, const Real* fill,
                   const PlanePair<Real>& y);

  // Weights w of either end of each spring; `directions`: three components each; u, y: three arrays.
  /// J += w e of the ends' points, e = direction . (u_j - u_i).
  void (*inflow)(const SpringRun* runs, long count, const Real* directions, const Real* w_i, const Real* w_j,
                 const Real* const* u, Real* J);
  /// y += the transpose of that operator applied to p.
  void (*outflow)(const SpringRun* runs, long count, const Real* directions, const Real* w_i, const Real* w_j,
                  const Real* p, Real* const* y);

  // Vector updates, n values each.
  /// r -= y; z = a z + b d r; x += z.
  void (*chebyshev)(long n, const Real* y, const Real* d, Real a, Real b, Real* r, Real* z, Real* x);
  /// r -= y + c z; z = a z + b d r; x += z.
  void (*schur_step)(long n, const Real* y, const Real* c, const Real* d, Real a, Real b, Real* r, Real* z, Real* x);

  // Trilinear transfer along x, weights 1/2 1 1/2; `odd`: the fine row begins between two coarse points.
  /// coarse += weight * restriction of fine.
  void (*restrict_row)(int fine_points, bool odd, Real weight, const Real* fine, Real* coarse);
  /// fine = weight * interpolation of the sum of `count` coarse rows.
  void (*prolongate_row)(int fine_points, bool odd, Real weight, const Real* const* coarse, int count, Real* fine);
};

}  // namespace springproof
