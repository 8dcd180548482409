// SIMD vectors for kernels, which may include only these and plain structs.  Kernels are compiled with instructions
// that other processors lack, so they must not bring inline functions of Eigen or the standard containers into the
// program (tests/cli/kernels.sh).
#pragma once

#ifdef __wasm__
#define SPRINGPROOF_VECTOR_BYTES 16
#endif
#ifndef SPRINGPROOF_VECTOR_BYTES
#include <experimental/simd>
#endif

// Each instruction set has its own copy of a kernel, in this namespace.
#ifndef SPRINGPROOF_KERNEL_NAMESPACE
#error "kernels are compiled by msm_kernels() in msm/CMakeLists.txt"
#endif

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

/// The compiler's own vector of n values.
template <class Value, int n>
struct Builtin {
  typedef Value type __attribute__((vector_size(n * sizeof(Value))));
};

#ifdef SPRINGPROOF_VECTOR_BYTES
namespace stdx {
#include "msm/kernels/compiled/simd_of_vectors.h"
}
#else
namespace stdx = std::experimental;
#endif

template <class Real>
using Lanes = stdx::native_simd<Real>;  ///< 2, 4, 8 doubles; 4, 8, 16 floats

/// Fetches what will be changed soon; any place.
template <class Real>
inline void prefetch(const Real* p) {
  __builtin_prefetch(p, 1);
}

template <class Real>
inline Lanes<Real> load(const Real* p) {
  return Lanes<Real>(p, stdx::element_aligned);
}

template <class Real>
inline void store(const Lanes<Real>& v, Real* p) {
  v.copy_to(p, stdx::element_aligned);
}

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
