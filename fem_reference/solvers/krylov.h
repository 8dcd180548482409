// Krylov methods.
#pragma once

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

/// For any matrix and preconditioner, without restart: stores two vectors per iteration.  Adds to x, which starts at
/// zero, until the residual has shrunk by `reduction` in the norm of `dot`.  The preconditioner acts from the right and
/// may change from one application to the next (FGMRES, Saad 1993).
template <typename Vector, typename Multiply, typename Precondition, typename Dot>
KrylovOutcome gmres(const Multiply& multiply, const Precondition& precondition, const Dot& dot, const Vector& b,
                    double reduction, int max_iterations, Vector& x) {
  KrylovOutcome outcome;
  const double start = std::sqrt(dot(b, b));
  if (start == 0) return outcome;
  std::vector<Vector> v = {b}, z;  // v orthonormal, z_j = P^-1 v_j
  v[0].sadd(1 / start, 0, v[0]);
  std::vector<std::vector<double>> R;             // columns of the Hessenberg matrix, made triangular
  std::vector<std::pair<double, double>> givens;  // cosine, sine
  std::vector<double> rhs = {start};
  while (outcome.iterations < max_iterations && outcome.reduction > reduction) {
    const int j = outcome.iterations++;
    z.push_back(x);
    precondition(z[j], v[j]);
    Vector w = b;
    multiply(w, z[j]);
    std::vector<double> h(j + 1, 0.0);
    for (int i = 0; i <= j; ++i) {
      h[i] = dot(w, v[i]);
      w.add(-h[i], v[i]);
    }
    const double norm = std::sqrt(dot(w, w));
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
    v.push_back(std::move(w));
  }
  for (int j = int(R.size()) - 1; j >= 0; --j) {
    rhs[j] /= R[j][j];
    for (int i = 0; i < j; ++i) rhs[i] -= R[j][i] * rhs[j];
    x.add(rhs[j], z[j]);
  }
  return outcome;
}

}  // namespace springproof::fem
