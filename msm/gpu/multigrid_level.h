// The operator of a level of lattice multigrid, its smoother and its transfer, per cell and per node.
#pragma once

#include "msm/gpu/sweep.h"
#include "msm/kernels/cell_kernels.h"

namespace springproof::gpu {

/// Stiffness of equal cells times the fraction that the body fills of each (CellBlocks); no forces in translations.
template <class Real>
struct LinearCells {
  static constexpr bool has_cells = true;
  CellBlocks<Real> K;
  const Real* fill;  ///< per place of the cell's lowest corner, 0: no cell

  SPRINGPROOF_INLINE bool present(int at) const { return fill[at] != Real(0); }

  SPRINGPROOF_INLINE void derivative(int at, const Real (&along)[3][3], const Real (&S)[3][4], Real (&A)[3][3],
                                     Real (&B)[3][4]) const {
    // By sign pattern, bits x, y, z: along x 1, y 2, z 4; S: yz 6, zx 5, xy 3, xyz 7.
    const Real w = fill[at];
    Real u[3][8], f[3][8];
    for (int a = 0; a < 3; ++a) {
      u[a][0] = 0;
      u[a][1] = along[a][0], u[a][2] = along[a][1], u[a][4] = along[a][2];
      u[a][6] = S[a][0], u[a][5] = S[a][1], u[a][3] = S[a][2], u[a][7] = S[a][3];
    }
    SPRINGPROOF_UNROLL
    for (int t = 0; t < 8; ++t) {
      const Real* m = K.m[t];
      const Real x = u[0][t ^ 1], y = u[1][t ^ 2], z = u[2][t ^ 4];
      f[0][t ^ 1] = w * (m[0] * x + m[1] * y + m[2] * z);
      f[1][t ^ 2] = w * (m[1] * x + m[3] * y + m[4] * z);
      f[2][t ^ 4] = w * (m[2] * x + m[4] * y + m[5] * z);
    }
    for (int a = 0; a < 3; ++a) {
      A[a][0] = f[a][1], A[a][1] = f[a][2], A[a][2] = f[a][4];
      B[a][0] = f[a][6], B[a][1] = f[a][5], B[a][2] = f[a][3], B[a][3] = f[a][7];
    }
  }
};

/// y = K u on free unknowns, 0 on the others; the sum of u y.
template <class Real>
struct StoreProduct {
  const float* free;  ///< three components, not 0 on free unknowns; null: all are
  const Real* u;
  Real* y;
  int stride;
  SPRINGPROOF_INLINE void operator()(int at, const Real (&Ku)[3], double (&sums)[sums_of_launch]) const {
    for (int a = 0; a < 3; ++a) {
      const int i = a * stride + at;
      const Real value = !free || free[i] != 0 ? Ku[a] : Real(0);
      y[i] = value;
      sums[0] += double(value) * double(u[i]);
    }
  }
};

/// r -= K z; z' = a z + b D r; x += z'.
struct Smooth {
  const float* inverse_diagonal;  ///< 0 on fixed unknowns and where there is no node
  const float* z;
  float *next, *r, *x;
  int stride;
  float previous, step;
  SPRINGPROOF_INLINE void operator()(int at, const float (&Kz)[3], double (&)[sums_of_launch]) const {
    for (int a = 0; a < 3; ++a) {
      const int i = a * stride + at;
      const float residual = r[i] - Kz[a], change = previous * z[i] + step * inverse_diagonal[i] * residual;
      r[i] = residual;
      next[i] = change;
      x[i] += change;
    }
  }
};

/// r -= K z on free unknowns, 0 on the others.
struct TakeResidual {
  const float* inverse_diagonal;
  float* r;
  int stride;
  SPRINGPROOF_INLINE void operator()(int at, const float (&Kz)[3], double (&)[sums_of_launch]) const {
    for (int a = 0; a < 3; ++a) {
      const int i = a * stride + at;
      r[i] = inverse_diagonal[i] != 0 ? r[i] - Kz[a] : 0;
    }
  }
};

/// z = x = step D r.
struct FirstStep {
  const float *inverse_diagonal, *r;
  float *z, *x;
  float step;
  SPRINGPROOF_INLINE void operator()(long i, double (&)[sums_of_launch]) const {
    x[i] = z[i] = step * inverse_diagonal[i] * r[i];
  }
};

/// Point q of the coarser box is point 2 q of the finer, both counted from 0.
struct Transfer {
  Box fine, coarse;
};

/// Coarse field = the transpose of trilinear interpolation of the fine one; of node i of the coarse box.
struct Restrict {
  Transfer t;
  const float* fine;
  float* coarse;
  SPRINGPROOF_INLINE void operator()(long i, double (&)[sums_of_launch]) const {
    const int n = static_cast<int>(i);
    const int q[3] = {n % t.coarse.nodes[0], n / t.coarse.nodes[0] % t.coarse.nodes[1],
                      n / t.coarse.nodes[0] / t.coarse.nodes[1]};
    float sum[3] = {};
    for (int k = 0; k < 27; ++k) {
      const int d[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
      int p[3];
      bool inside = true;
      float weight = 1;
      for (int a = 0; a < 3; ++a) {
        p[a] = 2 * q[a] + d[a];
        inside = inside && p[a] >= 0 && p[a] < t.fine.nodes[a];
        if (d[a] != 0) weight *= 0.5f;
      }
      if (!inside) continue;
      const int at = p[0] + 1 + t.fine.row * (p[1] + 1) + t.fine.plane * (p[2] + 1);
      for (int a = 0; a < 3; ++a) sum[a] += weight * fine[a * t.fine.size + at];
    }
    const int at = q[0] + 1 + t.coarse.row * (q[1] + 1) + t.coarse.plane * (q[2] + 1);
    for (int a = 0; a < 3; ++a) coarse[a * t.coarse.size + at] = sum[a];
  }
};

/// z = the interpolated coarse field on free unknowns, 0 on the others; x += z.  Of node i of the fine box.
struct Prolongate {
  Transfer t;
  const float *coarse, *inverse_diagonal;
  float *z, *x;
  SPRINGPROOF_INLINE void operator()(long i, double (&)[sums_of_launch]) const {
    const int n = static_cast<int>(i);
    const int p[3] = {n % t.fine.nodes[0], n / t.fine.nodes[0] % t.fine.nodes[1],
                      n / t.fine.nodes[0] / t.fine.nodes[1]};
    int low[3], count[3];
    for (int a = 0; a < 3; ++a) {
      low[a] = p[a] / 2;
      count[a] = 1 + p[a] % 2;
    }
    float sum[3] = {};
    for (int dz = 0; dz < count[2]; ++dz)
      for (int dy = 0; dy < count[1]; ++dy)
        for (int dx = 0; dx < count[0]; ++dx) {
          const int at = low[0] + dx + 1 + t.coarse.row * (low[1] + dy + 1) + t.coarse.plane * (low[2] + dz + 1);
          for (int a = 0; a < 3; ++a) sum[a] += coarse[a * t.coarse.size + at];
        }
    const float weight = 1.0f / static_cast<float>(count[0] * count[1] * count[2]);
    const int at = p[0] + 1 + t.fine.row * (p[1] + 1) + t.fine.plane * (p[2] + 1);
    for (int a = 0; a < 3; ++a) {
      const int k = a * t.fine.size + at;
      const float value = inverse_diagonal[k] != 0 ? weight * sum[a] : 0;
      z[k] = value;
      x[k] += value;
    }
  }
};

/// The unknowns of a field at places, one after the other.
struct Gather {
  const int* places;
  const float* field;
  float* values;
  SPRINGPROOF_INLINE void operator()(long i, double (&)[sums_of_launch]) const { values[i] = field[places[i]]; }
};

/// x = K^-1 r of the coarsest level's free unknowns, unknown i.
struct SolveCoarsest {
  const float *inverse, *r;  ///< n x n, n
  const int* places;
  int n;
  float* x;
  SPRINGPROOF_INLINE void operator()(long i, double (&)[sums_of_launch]) const {
    float sum[8] = {};
    int j = 0;
    for (; j + 8 <= n; j += 8) {
      SPRINGPROOF_UNROLL
      for (int k = 0; k < 8; ++k) sum[k] += inverse[long(j + k) * n + i] * r[j + k];
    }
    for (; j < n; ++j) sum[0] += inverse[long(j) * n + i] * r[j];
    x[places[i]] = ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
  }
};

// Vectors of conjugate gradients.

/// r = r / scale in single precision.
struct Rounded {
  const double* r;
  float* to;
  double factor;
  SPRINGPROOF_INLINE void operator()(long i, double (&)[sums_of_launch]) const {
    to[i] = static_cast<float>(factor * r[i]);
  }
};
/// The sum of r z.
struct Product {
  const double* r;
  const float* z;
  SPRINGPROOF_INLINE void operator()(long i, double (&sums)[sums_of_launch]) const { sums[0] += r[i] * double(z[i]); }
};
/// p = factor z + beta p.
struct NextDirection {
  const float* z;
  double* p;
  double factor, beta;
  SPRINGPROOF_INLINE void operator()(long i, double (&)[sums_of_launch]) const {
    p[i] = factor * double(z[i]) + beta * p[i];
  }
};
/// u += alpha p; r -= alpha y; the sum of r^2.
struct StepAlong {
  const double *p, *y;
  double *u, *r;
  double alpha;
  SPRINGPROOF_INLINE void operator()(long i, double (&sums)[sums_of_launch]) const {
    u[i] += alpha * p[i];
    const double residual = r[i] - alpha * y[i];
    r[i] = residual;
    sums[0] += residual * residual;
  }
};
/// The sum of (b - y)^2.
struct Residual {
  const double *b, *y;
  SPRINGPROOF_INLINE void operator()(long i, double (&sums)[sums_of_launch]) const {
    const double residual = b[i] - y[i];
    sums[0] += residual * residual;
  }
};

}  // namespace springproof::gpu
