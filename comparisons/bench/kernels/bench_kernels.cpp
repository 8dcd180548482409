#include "comparisons/bench/kernels/bench_kernels.h"

#include <math.h>

#include "msm/kernels/compiled/simd_math.h"

namespace springproof::bench::SPRINGPROOF_KERNEL_NAMESPACE {
namespace {

namespace lanes = springproof::SPRINGPROOF_KERNEL_NAMESPACE;
template <class Real>
using Lanes = lanes::Lanes<Real>;

template <class Real>
void fma_rounds(long rounds, Real* sink) {
  Lanes<Real> a[fma_per_round];
  for (int i = 0; i < fma_per_round; ++i) a[i] = Real(i);
  const Lanes<Real> factor = Real(0.999) + Real(0) * *sink, term = Real(0.001);
  for (long r = 0; r < rounds; ++r)
#pragma GCC unroll 12
    for (int i = 0; i < fma_per_round; ++i) a[i] = a[i] * factor + term;
  for (int i = 1; i < fma_per_round; ++i) a[0] += a[i];
  *sink = a[0][0];
}

template <class Real>
void root_rounds(long rounds, Real* sink) {
  Lanes<Real> a[roots_per_round];
  for (int i = 0; i < roots_per_round; ++i) a[i] = Real(i + 1);
  const Lanes<Real> c = Real(2) + Real(0) * *sink;
  for (long r = 0; r < rounds; ++r)
#pragma GCC unroll 8
    for (int i = 0; i < roots_per_round; ++i) a[i] = c * lanes::inverse_root(a[i]);
  for (int i = 1; i < roots_per_round; ++i) a[0] += a[i];
  *sink = a[0][0];
}

double read(const double* a, long n) {
  constexpr int width = Lanes<double>::size();
  Lanes<double> sum[8] = {};
  for (long i = 0; i < n; i += 8 * width)
#pragma GCC unroll 8
    for (int k = 0; k < 8; ++k) sum[k] += lanes::load(a + i + k * width);
  for (int k = 1; k < 8; ++k) sum[0] += sum[k];
  return sum[0][0];
}

void triad(double* a, const double* b, const double* c, double s, long n) {
  constexpr int width = Lanes<double>::size();
  for (long i = 0; i < n; i += width) lanes::store<double>(lanes::load(b + i) + s * lanes::load(c + i), a + i);
}

void plain_step(PlainNode* nodes, long n, const PlainSpring* springs, long m, const double* dt_over_mass, double dt) {
  for (long s = 0; s < m; ++s) {
    const PlainSpring spring = springs[s];
    PlainNode &a = nodes[spring.i], &b = nodes[spring.j];
    const double d[3] = {b.x[0] - a.x[0], b.x[1] - a.x[1], b.x[2] - a.x[2]};
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const double pull = spring.stiffness * (length - spring.rest_length) / length;
    for (int c = 0; c < 3; ++c) {
      a.f[c] += pull * d[c];
      b.f[c] -= pull * d[c];
    }
  }
  for (long i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) {
      PlainNode& node = nodes[i];
      node.v[c] += dt_over_mass[i] * node.f[c];
      node.x[c] += dt * node.v[c];
      node.f[c] = 0;
    }
}

}  // namespace

BenchKernels bench_kernels() {
  return {int(Lanes<double>::size()),
          int(Lanes<float>::size()),
          fma_rounds<double>,
          fma_rounds<float>,
          root_rounds<double>,
          root_rounds<float>,
          read,
          triad,
          plain_step};
}

}  // namespace springproof::bench::SPRINGPROOF_KERNEL_NAMESPACE
