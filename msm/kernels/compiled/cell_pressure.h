// Pressure of the volume correction of a vector of cells.
#pragma once

#include "msm/kernels/compiled/simd_math.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

/// Pressure, per kappa, of cells with volume ratio J; arbitrary where there is no cell.
template <bool bounded, class Real>
SPRINGPROOF_INLINE Lanes<Real> pressure(Lanes<Real> J, const Lanes<Real>& kappa) {
  if constexpr (bounded) {
    stdx::where(kappa == Real(0), J) = 1;
    const Lanes<Real> d = J - Real(1);
    // 3 (J^(1/3) - 1) / J^(2/3); near 1 a series gives a start value that needs only one step.
    Lanes<Real> y;
    if (stdx::all_of(stdx::abs(d) < Real(0.125)))
      y = nearer_inverse_cube_root(J, Real(1) - d * (Real(1.0 / 3) - d * (Real(2.0 / 9) - d * Real(14.0 / 81))));
    else
      y = inverse_cube_root(J);
    return Real(3) * y * (Real(1) - y);
  } else {
    return J - Real(1);
  }
}

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE
