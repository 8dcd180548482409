#include "msm/algebra/krylov.h"

#include <Eigen/Dense>

namespace springproof {

KrylovResult conjugate_gradients(const Operator& A, const Operator& precondition, const Eigen::VectorXd& b,
                                 double tolerance, int max_iterations, Eigen::VectorXd& x) {
  KrylovResult result;
  const double scale = b.norm();
  if (scale == 0) {
    x.setZero();
    result.converged = true;
    return result;
  }
  Eigen::VectorXd r(b.size()), z(b.size()), p, q(b.size());
  A(x, q);
  r = b - q;
  double rz = 0;
  while (r.norm() > tolerance * scale && result.iterations < max_iterations) {
    precondition(r, z);
    const double rz_new = r.dot(z);
    if (result.iterations == 0)
      p = z;
    else
      p = z + rz_new / rz * p;
    rz = rz_new;
    A(p, q);
    const double curvature = p.dot(q);
    if (!(curvature > 0)) {
      result.negative_curvature = true;
      break;
    }
    const double alpha = rz / curvature;
    x += alpha * p;
    r -= alpha * q;
    ++result.iterations;
  }
  A(x, q);
  result.residual = (b - q).norm() / scale;
  result.converged = result.residual <= 10 * tolerance;
  return result;
}

KrylovResult gmres(const Operator& A, const Operator& precondition, const Eigen::VectorXd& b, double tolerance,
                   int max_iterations, int restart, Eigen::VectorXd& x) {
  KrylovResult result;
  const double scale = b.norm();
  if (scale == 0) {
    x.setZero();
    result.converged = true;
    return result;
  }
  Eigen::VectorXd w(b.size()), z(b.size());
  A(x, w);
  Eigen::VectorXd r = b - w;
  Eigen::MatrixXd V(b.size(), restart + 1);  // memory is taken as columns are written
  Eigen::MatrixXf Z(b.size(), restart);
  while (r.norm() > tolerance * scale && result.iterations < max_iterations) {
    const double beta = r.norm();
    V.col(0) = r / beta;
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(restart + 1, restart);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(restart + 1), cosine(restart), sine(restart);
    g[0] = beta;
    int k = 0;
    for (; k < restart && result.iterations < max_iterations; ++k) {
      ++result.iterations;
      w = V.col(k);
      precondition(w, z);
      Z.col(k) = z.cast<float>();
      z = Z.col(k).cast<double>();
      A(z, w);
      H.col(k).head(k + 1).noalias() = V.leftCols(k + 1).transpose() * w;
      w.noalias() -= V.leftCols(k + 1) * H.col(k).head(k + 1);
      const double length = H(k + 1, k) = w.norm();
      if (length > 0) V.col(k + 1) = w / length;
      for (int i = 0; i < k; ++i) {  // the Givens rotations so far
        const double h = cosine[i] * H(i, k) + sine[i] * H(i + 1, k);
        H(i + 1, k) = -sine[i] * H(i, k) + cosine[i] * H(i + 1, k);
        H(i, k) = h;
      }
      const double diagonal = std::hypot(H(k, k), H(k + 1, k));
      cosine[k] = H(k, k) / diagonal;
      sine[k] = H(k + 1, k) / diagonal;
      H(k, k) = diagonal;
      g[k + 1] = -sine[k] * g[k];
      g[k] *= cosine[k];
      if (std::abs(g[k + 1]) <= tolerance * scale || !(length > 0)) {
        ++k;
        break;
      }
    }
    const Eigen::VectorXd y = H.topLeftCorner(k, k).triangularView<Eigen::Upper>().solve(g.head(k));
    for (int i = 0; i < k; ++i) x += y[i] * Z.col(i).cast<double>();
    A(x, w);
    const double before = r.norm();
    r = b - w;
    if (!(r.norm() < before)) break;  // stagnation at round-off
  }
  result.residual = r.norm() / scale;
  result.converged = result.residual <= 10 * tolerance;
  return result;
}

}  // namespace springproof
