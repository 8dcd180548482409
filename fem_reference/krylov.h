// Krylov methods.  MINRES and GMRES minimise the residual in the norm of a symmetric, positive definite preconditioner
// P: |r|^2 = r . P^-1 r.  That norm makes forces and volumes comparable in a mixed system.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace springproof::fem {

struct KrylovOutcome {
  int iterations = 0;
  double reduction = 1;  ///< of the residual in the norm of the preconditioner
};

/// For symmetric, positive definite matrices.  Adds to x, which starts at zero, until the residual has shrunk by
/// `reduction` in the Euclidean norm.
template <typename Vector, typename Multiply, typename Precondition>
KrylovOutcome conjugate_gradients(const Multiply& multiply, const Precondition& precondition, const Vector& b,
                                  double reduction, int max_iterations, Vector& x) {
  KrylovOutcome outcome;
  Vector r = b, z = b, Ap = b;
  const double start = std::sqrt(r.dot(r));
  if (start == 0) return outcome;
  precondition(z, r);
  Vector p = z;
  double rz = r.dot(z);
  while (outcome.iterations < max_iterations && outcome.reduction > reduction) {
    ++outcome.iterations;
    multiply(Ap, p);
    const double curvature = p.dot(Ap);
    if (!(curvature > 0)) break;  // not positive definite, or solved to rounding
    const double alpha = rz / curvature;
    x.add(alpha, p);
    r.add(-alpha, Ap);
    outcome.reduction = std::sqrt(r.dot(r)) / start;
    if (outcome.reduction <= reduction) break;
    precondition(z, r);
    const double rz_old = std::exchange(rz, r.dot(z));
    p.sadd(rz / rz_old, 1, z);
  }
  return outcome;
}

/// For symmetric matrices.  Adds to x, which starts at zero, until the residual has shrunk by `reduction`.
/// `precondition(z, r)` is symmetric and positive definite.  Elman, Silvester, Wathen (2014), algorithm 4.1.
template <typename Vector, typename Multiply, typename Precondition>
KrylovOutcome minres(const Multiply& multiply, const Precondition& precondition, const Vector& b, double reduction,
                     int max_iterations, Vector& x) {
  KrylovOutcome outcome;
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

/// For any matrix, without restart (Saad and Schultz 1986): stores two vectors per iteration.  Otherwise as minres.
template <typename Vector, typename Multiply, typename Precondition>
KrylovOutcome gmres(const Multiply& multiply, const Precondition& precondition, const Vector& b, double reduction,
                    int max_iterations, Vector& x) {
  KrylovOutcome outcome;
  std::vector<Vector> v = {b}, z = {b};  // v_i . z_j = delta_ij, z = P^-1 v
  precondition(z[0], v[0]);
  const double start = std::sqrt(z[0].dot(v[0]));
  if (start == 0) return outcome;
  v[0].sadd(1 / start, 0, v[0]);
  z[0].sadd(1 / start, 0, z[0]);
  std::vector<std::vector<double>> R;             // columns of the Hessenberg matrix, made triangular
  std::vector<std::pair<double, double>> givens;  // cosine, sine
  std::vector<double> rhs = {start};
  while (outcome.iterations < max_iterations && outcome.reduction > reduction) {
    const int j = outcome.iterations++;
    Vector w = b, Pw = b;
    multiply(w, z[j]);
    std::vector<double> h(j + 1, 0.0);
    for (int i = 0; i <= j; ++i) {
      h[i] = w.dot(z[i]);
      w.add(-h[i], v[i]);
    }
    precondition(Pw, w);
    const double norm = std::sqrt(std::max(w.dot(Pw), 0.0));
    for (int i = 0; i < j; ++i) {
      const auto [c, s] = givens[i];
      const double upper = h[i];
      h[i] = c * upper + s * h[i + 1];
      h[i + 1] = c * h[i + 1] - s * upper;
    }
    const double length = std::hypot(h[j], norm);
    if (length == 0) break;
    givens.emplace_back(h[j] / length, norm / length);
    h[j] = length;
    R.push_back(std::move(h));
    rhs.push_back(-givens[j].second * rhs[j]);
    rhs[j] *= givens[j].first;
    outcome.reduction = std::abs(rhs[j + 1]) / start;
    if (norm == 0) break;
    w.sadd(1 / norm, 0, w);
    Pw.sadd(1 / norm, 0, Pw);
    v.push_back(std::move(w));
    z.push_back(std::move(Pw));
  }
  for (int j = int(R.size()) - 1; j >= 0; --j) {
    rhs[j] /= R[j][j];
    for (int i = 0; i < j; ++i) rhs[i] -= R[j][i] * rhs[j];
    x.add(rhs[j], z[j]);
  }
  return outcome;
}

}  // namespace springproof::fem
