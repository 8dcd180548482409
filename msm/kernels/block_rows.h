// Kernels for sparse matrices of 3x3 blocks, row by row.
#pragma once

namespace springproof {

/// A matrix on plain arrays; vectors hold three values per point.  Row n is that of a point; its blocks are
/// first[n] ... first[n] + end[n] - begin[n], nine values each, row by row, so that equal rows share them.
template <class Real>
struct BlockRows {
  long rows = 0;
  const int* point = nullptr;   ///< of each row; every point has one
  const int* begin = nullptr;   ///< first entry of each row
  const int* end = nullptr;     ///< beyond its last
  const int* column = nullptr;  ///< point of each entry
  const int* first = nullptr;   ///< first block of each row
  const Real* block = nullptr;  ///< with one value more beyond the last
};

/// Kernels of one instruction set.  `work`: four values per point.
template <class Real>
struct BlockRowKernels {
  /// y = A x.
  void (*multiply)(const BlockRows<Real>& A, const Real* x, Real* y, Real* work);
  /// r = b - A x.
  void (*residual)(const BlockRows<Real>& A, const Real* b, const Real* x, Real* r, Real* work);
  /// Gauss-Seidel: x_i += D_i (b - A x)_i, row by row, or from the last to the first.  D: nine values per
  /// point.
  void (*relax)(const BlockRows<Real>& A, const Real* D, bool ascending, const Real* b, Real* x, Real* work);
};

/// A product of dense matrices on plain arrays: `a` and `c` are stored by columns, b(k, j) at b[k b_row + j b_column].
template <class Real>
struct DenseProduct {
  long rows = 0, columns = 0, depth = 0;  ///< of c, and the columns of a
  const Real* a = nullptr;
  long a_column = 0;  ///< from one column of a to the next
  const Real* b = nullptr;
  long b_row = 0, b_column = 0;
  Real* c = nullptr;
  long c_column = 0;
};

/// Kernels of one instruction set.
template <class Real>
struct DenseKernels {
  /// c -= a b.
  void (*subtract)(const DenseProduct<Real>& product);
};

}  // namespace springproof
