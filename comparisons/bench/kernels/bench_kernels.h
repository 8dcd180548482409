// Bench kernels, compiled once per instruction set: loops that measure the limits of a core, and the plain loop over
// springs.
#pragma once

namespace springproof::bench {

/// A node of the plain loop.
struct PlainNode {
  double x[3], v[3], f[3];  ///< [m], [m/s], [N]
};

/// A spring of the plain loop, 24 bytes.
struct PlainSpring {
  int i, j;
  double stiffness, rest_length;  ///< [N/m], [m]
};

struct BenchKernels {
  int lanes64, lanes32;  ///< numbers in a vector
  /// Rounds of fma_per_round vector multiply-adds, independent of each other.
  void (*fma64)(long rounds, double* sink);
  void (*fma32)(long rounds, float* sink);
  /// Rounds of roots_per_round vectors c / sqrt(a), independent of each other, as the kernels take it.
  void (*root64)(long rounds, double* sink);
  void (*root32)(long rounds, float* sink);
  /// Sum of n numbers, n a multiple of 64, a aligned to 64 bytes.
  double (*read)(const double* a, long n);
  /// a = b + s c, n a multiple of 64.
  void (*triad)(double* a, const double* b, const double* c, double s, long n);
  /// One semi-implicit Euler step: forces spring by spring, then v += (dt/m) f, x += dt v; f is zero before and after.
  void (*plain_step)(PlainNode* nodes, long n, const PlainSpring* springs, long m, const double* dt_over_mass,
                     double dt);
};

inline constexpr int fma_per_round = 12, roots_per_round = 8;

// clang-format off
namespace portable { BenchKernels bench_kernels(); }
namespace avx2 { BenchKernels bench_kernels(); }
namespace avx512 { BenchKernels bench_kernels(); }
// clang-format on

}  // namespace springproof::bench
