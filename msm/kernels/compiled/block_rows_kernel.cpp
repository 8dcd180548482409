// Products and Gauss-Seidel sweeps of sparse matrices of 3x3 blocks: a block's rows, and the vector of its column, are
// read as vectors of four values, of which the last does not count.
#include "msm/kernels/compiled/all_kernels.h"
#include "msm/kernels/compiled/simd.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {
namespace {

template <class Real>
using Four = typename Builtin<Real, 4>::type;

template <class Real>
inline Four<Real> four(const Real* p) {
  Four<Real> v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

template <class Real>
inline void put(const Four<Real>& v, Real* p) {
  __builtin_memcpy(p, &v, sizeof v);
}

/// The vectors lie apart: one that was stored as a whole can be read again at once.
template <class Real>
void spread(long points, const Real* x, Real* work) {
  for (long i = 0; i < points; ++i) {
    for (int a = 0; a < 3; ++a) work[4 * i + a] = x[3 * i + a];
    work[4 * i + 3] = 0;
  }
}

/// Rows of blocks times vectors, lane by lane; to be summed over the first three lanes.
template <class Real>
struct Products {
  Four<Real> of_row[3] = {};

  void add(const Real* block, const Real* v) {
    const Four<Real> x = four(v);
    for (int a = 0; a < 3; ++a) of_row[a] += four(block + 3 * a) * x;
  }
};

/// (A x) of row n.
template <class Real>
inline void row_times(const BlockRows<Real>& A, long n, const Real* work, Real* out) {
  Products<Real> even, odd;
  const int end = A.end[n];
  const Real* block = A.block + 9 * long(A.first[n]);
  int e = A.begin[n];
  for (; e + 1 < end; e += 2, block += 18) {
    even.add(block, work + 4 * long(A.column[e]));
    odd.add(block + 9, work + 4 * long(A.column[e + 1]));
  }
  if (e < end) even.add(block, work + 4 * long(A.column[e]));
  for (int a = 0; a < 3; ++a) {
    const Four<Real> sum = even.of_row[a] + odd.of_row[a];
    out[a] = sum[0] + sum[1] + sum[2];
  }
}

template <class Real>
void multiply(const BlockRows<Real>& A, const Real* x, Real* y, Real* work) {
  spread(A.rows, x, work);
  for (long n = 0; n < A.rows; ++n) row_times(A, n, work, y + 3 * long(A.point[n]));
}

template <class Real>
void residual(const BlockRows<Real>& A, const Real* b, const Real* x, Real* r, Real* work) {
  spread(A.rows, x, work);
  Real Ax[3];
  for (long n = 0; n < A.rows; ++n) {
    row_times(A, n, work, Ax);
    const long i = 3 * long(A.point[n]);
    for (int a = 0; a < 3; ++a) r[i + a] = b[i + a] - Ax[a];
  }
}

template <class Real>
void relax(const BlockRows<Real>& A, const Real* D, bool ascending, const Real* b, Real* x, Real* work) {
  spread(A.rows, x, work);
  Real r[3];
  for (long m = 0; m < A.rows; ++m) {
    const long n = ascending ? m : A.rows - 1 - m, i = A.point[n];
    row_times(A, n, work, r);
    for (int a = 0; a < 3; ++a) r[a] = b[3 * i + a] - r[a];
    const Real* d = D + 9 * i;
    const Four<Real> column[3] = {{d[0], d[3], d[6]}, {d[1], d[4], d[7]}, {d[2], d[5], d[8]}};
    put<Real>(four(work + 4 * i) + r[0] * column[0] + r[1] * column[1] + r[2] * column[2], work + 4 * i);
  }
  for (long i = 0; i < A.rows; ++i)
    for (int a = 0; a < 3; ++a) x[3 * i + a] = work[4 * i + a];
}

}  // namespace

template <class Real>
BlockRowKernels<Real> block_row_kernels() {
  return {.multiply = multiply<Real>, .residual = residual<Real>, .relax = relax<Real>};
}

template BlockRowKernels<double> block_row_kernels();
template BlockRowKernels<float> block_row_kernels();

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
