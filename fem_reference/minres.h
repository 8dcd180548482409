// The preconditioned minimal residual method for symmetric, indefinite systems.
#pragma once

#include <cmath>
#include <utility>

namespace springproof::fem {

struct MinresOutcome {
  int iterations = 0;
  double reduction = 1;  ///< of the residual in the norm of the preconditioner
};

/// Adds to x, which starts at zero, until the residual has shrunk by `reduction`.  `precondition(z, r)` is
/// symmetric and positive definite.  Elman, Silvester, Wathen (2014), algorithm 4.1.
template <typename Vector, typename Multiply, typename Precondition>
MinresOutcome minres(const Multiply& multiply, const Precondition& precondition, const Vector& b,
                     double reduction, int max_iterations, Vector& x) {
  MinresOutcome outcome;
  Vector v = b, v_old = b, z = b, z_next = b, w = x, w_old = x, Az = b;
  precondition(z, v);
  double gamma = std::sqrt(z.dot(v)), gamma_old = 1;
  if (gamma == 0) return outcome;
  const double start = gamma;
  double eta = gamma, c = 1, c_old = 1, s = 0, s_old = 0;
  v_old.sadd(0, 0, b);
  while (outcome.iterations < max_iterations && outcome.reduction > reduction) {
    ++outcome.iterations;
    z.sadd(1 / gamma, 0, z);
    multiply(Az, z);
    const double delta = Az.dot(z);
    // v_old <- A z - (delta / gamma) v - (gamma / gamma_old) v_old
    v_old.sadd(-gamma / gamma_old, -delta / gamma, v);
    v_old.add(1, Az);
    std::swap(v, v_old);
    precondition(z_next, v);
    const double gamma_next = std::sqrt(std::max(z_next.dot(v), 0.0));
    const double a0 = c * delta - c_old * s * gamma;
    const double a1 = std::hypot(a0, gamma_next);
    const double a2 = s * delta + c_old * c * gamma;
    const double a3 = s_old * gamma;
    // w_old <- (z - a3 w_old - a2 w) / a1
    w_old.sadd(-a3 / a1, -a2 / a1, w);
    w_old.add(1 / a1, z);
    std::swap(w, w_old);
    c_old = std::exchange(c, a0 / a1);
    s_old = std::exchange(s, gamma_next / a1);
    x.add(c * eta, w);
    eta *= -s;
    gamma_old = std::exchange(gamma, gamma_next);
    std::swap(z, z_next);
    outcome.reduction = std::abs(eta) / start;
    if (gamma == 0) break;
  }
  return outcome;
}

}  // namespace springproof::fem
