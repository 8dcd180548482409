// Products of dense matrices, in tiles of a few vectors of rows times a few columns that stay in registers.
#include "msm/kernels/compiled/all_kernels.h"
#include "msm/kernels/compiled/simd.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {
namespace {

constexpr int tile_vectors = 3, tile_columns = 4;

/// Of rows and columns from the first on.
template <int vectors, int columns, class Real>
inline void subtract_tile(const DenseProduct<Real>& p) {
  constexpr long lanes = Lanes<Real>::size();
  Lanes<Real> sum[columns][vectors];
  for (int j = 0; j < columns; ++j)
    for (int v = 0; v < vectors; ++v) sum[j][v] = load(p.c + j * p.c_column + v * lanes);
  for (long k = 0; k < p.depth; ++k) {
    Lanes<Real> a[vectors];
    for (int v = 0; v < vectors; ++v) a[v] = load(p.a + k * p.a_column + v * lanes);
    for (int j = 0; j < columns; ++j) {
      const Lanes<Real> b = p.b[k * p.b_row + j * p.b_column];
      for (int v = 0; v < vectors; ++v) sum[j][v] -= a[v] * b;
    }
  }
  for (int j = 0; j < columns; ++j)
    for (int v = 0; v < vectors; ++v) store(sum[j][v], p.c + j * p.c_column + v * lanes);
}

/// Of rows from the first on, all columns.
template <int vectors, class Real>
void subtract_strip(DenseProduct<Real> p) {
  long j = 0;
  for (; j + tile_columns <= p.columns; j += tile_columns) {
    subtract_tile<vectors, tile_columns>(p);
    p.b += tile_columns * p.b_column;
    p.c += tile_columns * p.c_column;
  }
  for (; j < p.columns; ++j, p.b += p.b_column, p.c += p.c_column) subtract_tile<vectors, 1>(p);
}

/// Of fewer rows than a vector has lanes: copies that are filled up with zeros.
template <class Real>
void subtract_rest(const DenseProduct<Real>& p) {
  constexpr long lanes = Lanes<Real>::size(), most_depth = 128, most_columns = 16;
  Real a[lanes * most_depth] = {}, c[lanes * most_columns] = {};
  for (long k = 0; k < p.depth; k += most_depth) {
    const long depth = p.depth - k < most_depth ? p.depth - k : most_depth;
    for (long m = 0; m < depth; ++m)
      for (long i = 0; i < p.rows; ++i) a[m * lanes + i] = p.a[(k + m) * p.a_column + i];
    for (long j = 0; j < p.columns; j += most_columns) {
      const long columns = p.columns - j < most_columns ? p.columns - j : most_columns;
      Real* const to = p.c + j * p.c_column;
      for (long n = 0; n < columns; ++n)
        for (long i = 0; i < p.rows; ++i) c[n * lanes + i] = to[n * p.c_column + i];
      const Real* const b = p.b + k * p.b_row + j * p.b_column;
      subtract_strip<1>(DenseProduct<Real>{lanes, columns, depth, a, lanes, b, p.b_row, p.b_column, c, lanes});
      for (long n = 0; n < columns; ++n)
        for (long i = 0; i < p.rows; ++i) to[n * p.c_column + i] = c[n * lanes + i];
    }
  }
}

template <class Real>
void subtract(const DenseProduct<Real>& product) {
  constexpr long lanes = Lanes<Real>::size();
  DenseProduct<Real> p = product;
  const auto next = [&](long rows) {
    p.rows -= rows;
    p.a += rows;
    p.c += rows;
  };
  for (; p.rows >= tile_vectors * lanes; next(tile_vectors * lanes)) subtract_strip<tile_vectors>(p);
  for (; p.rows >= lanes; next(lanes)) subtract_strip<1>(p);
  if (p.rows > 0) subtract_rest(p);
}

}  // namespace

template <class Real>
DenseKernels<Real> dense_kernels() {
  return {.subtract = subtract<Real>};
}

template DenseKernels<double> dense_kernels();
template DenseKernels<float> dense_kernels();

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
