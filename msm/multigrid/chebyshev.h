// Chebyshev iteration.
#pragma once

namespace springproof {

/// Coefficients of step k = 1, 2, ... of Chebyshev iteration of the fourth kind, z = previous z + step D r.
struct ChebyshevStep {
  double previous, step;
  ChebyshevStep(int k, double largest_eigenvalue)
      : ChebyshevStep{k > 1 ? (2.0 * k - 3) / (2.0 * k + 1) : 0, (8.0 * k - 4) / ((2.0 * k + 1) * largest_eigenvalue)} {
  }
  ChebyshevStep(double of_previous, double of_residual) : previous(of_previous), step(of_residual) {}
};

}  // namespace springproof
