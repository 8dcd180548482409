// Vectors of nodes, four numbers each, and of groups of them.  For the list kernels only.
#pragma once

#include "msm/kernels/compiled/simd_math.h"
#include "msm/kernels/list_kernels.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

template <class Real, int n>
struct VectorOf {
  typedef Real type __attribute__((vector_size(n * sizeof(Real)), aligned(sizeof(Real)), may_alias));
};
template <class Real>
struct FourOf {
  typedef Real type __attribute__((vector_size(4 * sizeof(Real)), may_alias));
};
template <class Real>
using Four = typename FourOf<Real>::type;  // at an aligned address

// Number of blocks whose roots fill a register.
template <class Real>
constexpr int group = Lanes<Real>::size() < 4 ? 1 : static_cast<int>(Lanes<Real>::size()) / 4;
template <class Real>
using Wide = typename VectorOf<Real, 4 * group<Real>>::type;

template <class Real>
inline Four<Real> four(const Padded<Real>* p, int n) {
  return *reinterpret_cast<const Four<Real>*>(p + n);
}

template <class Real>
inline Four<Real>& four(Padded<Real>* p, int n) {
  return *reinterpret_cast<Four<Real>*>(p + n);
}

template <class Real>
inline Four<Real> all(Real s) {
  return Four<Real>{s, s, s, s};
}

template <class Real>
inline Wide<Real> wide(const Real* p) {
  return *reinterpret_cast<const Wide<Real>*>(p);
}

template <class Real>
inline Wide<Real>& wide(Real* p) {
  return *reinterpret_cast<Wide<Real>*>(p);
}

template <class Real>
inline Wide<Real> join(const Four<Real>* parts) {
  if constexpr (group<Real> == 1)
    return parts[0];
  else if constexpr (group<Real> == 2)
    return __builtin_shufflevector(parts[0], parts[1], 0, 1, 2, 3, 4, 5, 6, 7);
  else
    return __builtin_shufflevector(__builtin_shufflevector(parts[0], parts[1], 0, 1, 2, 3, 4, 5, 6, 7),
                                   __builtin_shufflevector(parts[2], parts[3], 0, 1, 2, 3, 4, 5, 6, 7), 0, 1, 2, 3, 4,
                                   5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

/// Of every four numbers of p (0 to 3) and those of q (4 to 7) the ones named.
template <class Real, int a, int b, int c, int d>
SPRINGPROOF_INLINE Wide<Real> pick(const Wide<Real>& p, const Wide<Real>& q) {
  constexpr int n = 4 * group<Real> - 4, A = a < 4 ? a : a + n, B = b < 4 ? b : b + n, C = c < 4 ? c : c + n,
                D = d < 4 ? d : d + n;
  if constexpr (group<Real> == 1)
    return __builtin_shufflevector(p, q, A, B, C, D);
  else if constexpr (group<Real> == 2)
    return __builtin_shufflevector(p, q, A, B, C, D, A + 4, B + 4, C + 4, D + 4);
  else
    return __builtin_shufflevector(p, q, A, B, C, D, A + 4, B + 4, C + 4, D + 4, A + 8, B + 8, C + 8, D + 8, A + 12,
                                   B + 12, C + 12, D + 12);
}

/// Components of 4 group<Real> nodes, one vector each; the fourth only if `count` is 4.
template <int count, class Real>
SPRINGPROOF_INLINE void gather(const Padded<Real>* from, const int* nodes, Real (*components)[4 * group<Real>]) {
  Wide<Real> rows[4];
  for (int l = 0; l < 4; ++l) {
    Four<Real> parts[group<Real>];
    for (int g = 0; g < group<Real>; ++g) parts[g] = four(from, nodes[4 * g + l]);
    rows[l] = join<Real>(parts);
  }
  const Wide<Real> xz = pick<Real, 0, 4, 2, 6>(rows[0], rows[1]), xz_far = pick<Real, 0, 4, 2, 6>(rows[2], rows[3]);
  const Wide<Real> yw = pick<Real, 1, 5, 3, 7>(rows[0], rows[1]), yw_far = pick<Real, 1, 5, 3, 7>(rows[2], rows[3]);
  wide(components[0]) = pick<Real, 0, 1, 4, 5>(xz, xz_far);
  wide(components[1]) = pick<Real, 0, 1, 4, 5>(yw, yw_far);
  wide(components[2]) = pick<Real, 2, 3, 6, 7>(xz, xz_far);
  if constexpr (count == 4) wide(components[3]) = pick<Real, 2, 3, 6, 7>(yw, yw_far);
}

/// Adds three components to 4 group<Real> nodes, which may be the same.
template <class Real>
SPRINGPROOF_INLINE void scatter(const Real (*components)[4 * group<Real>], const int* nodes, Padded<Real>* to) {
  const Wide<Real> x = wide(components[0]), y = wide(components[1]), z = wide(components[2]), none = {};
  const Wide<Real> xy = pick<Real, 0, 4, 2, 6>(x, y), xy_far = pick<Real, 1, 5, 3, 7>(x, y);
  const Wide<Real> z_near = pick<Real, 0, 4, 2, 6>(z, none), z_far = pick<Real, 1, 5, 3, 7>(z, none);
  const Wide<Real> rows[4] = {pick<Real, 0, 1, 4, 5>(xy, z_near), pick<Real, 0, 1, 4, 5>(xy_far, z_far),
                              pick<Real, 2, 3, 6, 7>(xy, z_near), pick<Real, 2, 3, 6, 7>(xy_far, z_far)};
  for (int l = 0; l < 4; ++l) {
    Four<Real> parts[group<Real>];
    reinterpret_cast<Wide<Real>&>(parts) = rows[l];
    for (int g = 0; g < group<Real>; ++g) four(to, nodes[4 * g + l]) += parts[g];
  }
}

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
