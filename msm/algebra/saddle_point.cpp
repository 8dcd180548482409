#include "msm/algebra/saddle_point.h"

#include "msm/algebra/fixed.h"

namespace springproof {

KrylovResult solve_saddle_point(SaddlePoint& system, const std::vector<char>& fixed, const MixedVector& b,
                                double tolerance, int max_iterations, MixedVector& x) {
  const Eigen::Index n = b.u.size(), m = b.p.size();
  const auto stack = [&](const Eigen::VectorXd& u, const Eigen::VectorXd& p, Eigen::VectorXd& both) {
    both.resize(n + m);
    both << u, p;
    clear_fixed(fixed, both);
  };
  const auto parts = [&](const Eigen::VectorXd& both) { return MixedVector{both.head(n), both.tail(m)}; };
  const Operator A = [&](const Eigen::VectorXd& v, Eigen::VectorXd& y) {
    const MixedVector at = parts(v);
    stack(system.force(at), system.volume_change(at.u) - system.compliance().cwiseProduct(at.p), y);
  };
  const Operator precondition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    const MixedVector near = system.cycle(parts(r));
    stack(near.u, near.p, z);
  };
  Eigen::VectorXd right, both = Eigen::VectorXd::Zero(n + m);
  stack(b.u, b.p, right);
  const KrylovResult result = gmres(A, precondition, right, tolerance, max_iterations, 60, both);
  x = parts(both);
  return result;
}

}  // namespace springproof
