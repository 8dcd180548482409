// Kernels for dense matrices.
#pragma once

namespace springproof {

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
