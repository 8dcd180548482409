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

}  // namespace springproof
