// Vector functions that std::experimental::simd lacks.  For kernels only.
#pragma once

#ifdef SPRINGPROOF_ONE_LANE
#include "msm/kernels/compiled/one_lane.h"
#else

#include "msm/kernels/compiled/simd.h"

/// Forces inlining: the compiler considers the larger of a kernel's small functions too large for it.
#define SPRINGPROOF_INLINE inline __attribute__((always_inline))

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

template <class Real>
constexpr int lanes = static_cast<int>(Lanes<Real>::size());

template <class Real>
using RealVector = typename Builtin<Real, lanes<Real> >::type;

/// (last of `before`, all but the last of `v`).
#ifdef __wasm__
SPRINGPROOF_INLINE Lanes<double> shift_in(const Lanes<double>& before, const Lanes<double>& v) {
  return Lanes<double>(
      __builtin_shufflevector(static_cast<RealVector<double> >(before), static_cast<RealVector<double> >(v), 1, 2));
}
SPRINGPROOF_INLINE Lanes<float> shift_in(const Lanes<float>& before, const Lanes<float>& v) {
  return Lanes<float>(
      __builtin_shufflevector(static_cast<RealVector<float> >(before), static_cast<RealVector<float> >(v), 3, 4, 5, 6));
}
#else
SPRINGPROOF_INLINE Lanes<double> shift_in(const Lanes<double>& before, const Lanes<double>& v) {
  typename Builtin<long long, lanes<double> >::type order;
  for (int i = 0; i < lanes<double>; ++i) order[i] = lanes<double> - 1 + i;
  return Lanes<double>(
      __builtin_shuffle(static_cast<RealVector<double> >(before), static_cast<RealVector<double> >(v), order));
}
SPRINGPROOF_INLINE Lanes<float> shift_in(const Lanes<float>& before, const Lanes<float>& v) {
  typename Builtin<int, lanes<float> >::type order;
  for (int i = 0; i < lanes<float>; ++i) order[i] = lanes<float> - 1 + i;
  return Lanes<float>(
      __builtin_shuffle(static_cast<RealVector<float> >(before), static_cast<RealVector<float> >(v), order));
}
#endif

#if defined(__AVX512F__) || SPRINGPROOF_VECTOR_BYTES == 64
#define SPRINGPROOF_ESTIMATED_ROOTS
/// 1 / sqrt(square) with an error of at most 2^-14: the instruction's estimate; where AVX-512 is made of narrower
/// vectors, with the largest error that the instruction may have.
template <class Real>
SPRINGPROOF_INLINE Lanes<Real> estimated_inverse_root(const Lanes<Real>& square) {
#ifndef __AVX512F__
  return Real(1 + 0x1p-14) / stdx::sqrt(square);
#else
  if constexpr (sizeof(Real) == 8)
    return Lanes<Real>(_mm512_rsqrt14_pd(static_cast<RealVector<Real> >(square)));
  else
    return Lanes<Real>(_mm512_rsqrt14_ps(static_cast<RealVector<Real> >(square)));
#endif
}
#endif

/// 1 / sqrt(square) to two units in the last place, subnormal numbers included.  With AVX-512 from an estimate of 14
/// bits by one step of fourth order, which makes NaN of 0 and infinity.
template <class Real>
SPRINGPROOF_INLINE Lanes<Real> inverse_root(const Lanes<Real>& square) {
#ifdef SPRINGPROOF_ESTIMATED_ROOTS
  const Lanes<Real> y = estimated_inverse_root(square), e = Real(1) - square * y * y;
  if constexpr (sizeof(Real) == 4) return y + y * e * (Real(0.5) + e * Real(0.375));
  return y + y * e * (Real(0.5) + e * (Real(0.375) + e * Real(0.3125)));  // (1 - e)^(-1/2)
#else
  return Real(1) / stdx::sqrt(square);
#endif
}

/// J^(-1/3) from an approximation y, by one step of fourth order.
template <class Real>
SPRINGPROOF_INLINE Lanes<Real> nearer_inverse_cube_root(const Lanes<Real>& J, const Lanes<Real>& y) {
  const Lanes<Real> e = Real(1) - J * y * y * y;  // (1 - e)^(-1/3) = 1 + e/3 + 2 e^2/9 + 14 e^3/81 + ...
  return y + y * e * (Real(1.0 / 3) + e * (Real(2.0 / 9) + e * Real(14.0 / 81)));
}

/// J^(-1/3), with the sign of J, by two steps of fourth order from a single-precision guess (10 %) derived from the
/// bits of J.
template <class Real>
SPRINGPROOF_INLINE Lanes<Real> inverse_cube_root(const Lanes<Real>& J) {
  using Float = typename Builtin<float, lanes<Real> >::type;
  using Int = typename Builtin<int, lanes<Real> >::type;
  const Lanes<Real> size = stdx::abs(J);
  const Float s = __builtin_convertvector(static_cast<RealVector<Real> >(size), Float);
  const Float third = __builtin_convertvector(reinterpret_cast<Int>(s), Float) * (-1.0f / 3);
  const Int bits = __builtin_convertvector(third, Int) +
                   0x54a21d2a;  // 4/3 of the exponent's bias, and a shift that spreads the error
  Lanes<Real> y(__builtin_convertvector(reinterpret_cast<Float>(bits), RealVector<Real>));
  for (int step = 0; step < 2; ++step) y = nearer_inverse_cube_root(size, y);
  stdx::where(J < Real(0), y) = -y;
  return y;
}

/// ln(1 + d) where no series serves.
template <class Real>
SPRINGPROOF_INLINE Lanes<Real> plain_logarithm_of_1_and(const Lanes<Real>& d) {
  Real values[lanes<Real>];
  store(d, values);
  for (Real& value : values) value = static_cast<Real>(__builtin_log1p(static_cast<double>(value)));
  return load(values);
}

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE

#endif
