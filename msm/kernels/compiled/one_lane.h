// Vectors of one number, in place of msm/kernels/compiled/simd.h and simd_math.h: for GPUs, where a thread is a lane.
#pragma once

#include <cmath>

#ifdef __CUDACC__
#define SPRINGPROOF_INLINE __host__ __device__ __forceinline__
#else
#define SPRINGPROOF_INLINE inline
#endif

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

template <class Real>
using Lanes = Real;

namespace stdx {

SPRINGPROOF_INLINE bool all_of(bool b) { return b; }
SPRINGPROOF_INLINE bool any_of(bool b) { return b; }
template <class Real>
SPRINGPROOF_INLINE Real abs(Real value) {
  return value < 0 ? -value : value;
}

/// What where() returns: assignment to a value under a condition.
template <class Real>
struct Where {
  bool condition;
  Real& value;
  template <class Other>
  SPRINGPROOF_INLINE void operator=(const Other& other) {
    if (condition) value = Real(other);
  }
};
template <class Real>
SPRINGPROOF_INLINE Where<Real> where(bool condition, Real& value) {
  return {condition, value};
}

}  // namespace stdx

/// 1 / sqrt(square).
template <class Real>
SPRINGPROOF_INLINE Real inverse_root(Real square) {
#ifdef __CUDA_ARCH__
  return rsqrt(square);
#else
  return 1 / std::sqrt(square);
#endif
}

/// J^(-1/3), with the sign of J.
template <class Real>
SPRINGPROOF_INLINE Real inverse_cube_root(Real J) {
#ifdef __CUDA_ARCH__
  return rcbrt(J);
#else
  return 1 / std::cbrt(J);
#endif
}

/// J^(-1/3) from an approximation y, by one step of fourth order.
template <class Real>
SPRINGPROOF_INLINE Real nearer_inverse_cube_root(Real J, Real y) {
  const Real e = Real(1) - J * y * y * y;
  return y + y * e * (Real(1.0 / 3) + e * (Real(2.0 / 9) + e * Real(14.0 / 81)));
}

/// ln(1 + d) where no series serves.
template <class Real>
SPRINGPROOF_INLINE Real plain_logarithm_of_1_and(Real d) {
  return std::log1p(d);
}

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
