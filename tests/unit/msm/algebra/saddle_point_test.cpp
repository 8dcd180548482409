// Saddle points against a dense solution.
#include "msm/algebra/saddle_point.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "msm/algebra/fixed.h"
#include "msm/algebra/noise.h"

namespace springproof::saddle_point_test {
namespace {

constexpr int n = 12, m = 5;

/// K = 3 I + a part of rank one, preconditioned by its diagonal and no pressure of neighbours.
class Small : public SaddlePoint {
 public:
  Small() : B_(m, n), C_(Eigen::VectorXd::LinSpaced(m, 0, 0.4)), v_(n) {
    fill_with_noise(B_.reshaped());
    fill_with_noise(v_);
  }
  Eigen::MatrixXd stiffness() const { return 3 * Eigen::MatrixXd::Identity(n, n) + v_ * v_.transpose(); }

  Eigen::VectorXd force(const MixedVector& x) override { return stiffness() * x.u + B_.transpose() * x.p; }
  Eigen::VectorXd volume_change(const Eigen::VectorXd& u) override { return B_ * u; }
  const Eigen::VectorXd& compliance() const override { return C_; }
  MixedVector cycle(const MixedVector& b) override { return {b.u / 3, -b.p}; }

 private:
  Eigen::MatrixXd B_;
  Eigen::VectorXd C_, v_;
};

TEST(SaddlePoint, IsSolvedOnTheFreeUnknowns) {
  Small system;
  std::vector<char> fixed(n, 0);
  fixed[0] = fixed[7] = 1;
  MixedVector exact{Eigen::VectorXd(n), Eigen::VectorXd(m)}, x;
  fill_with_noise(exact.u);
  fill_with_noise(exact.p);
  clear_fixed(fixed, exact.u);
  const MixedVector b{system.force(exact),  // on fixed unknowns: what the supports hold
                      system.volume_change(exact.u) - system.compliance().cwiseProduct(exact.p)};
  const KrylovResult result = solve_saddle_point(system, fixed, b, 1e-12, 100, x);
  EXPECT_TRUE(result.converged);
  EXPECT_LE(result.iterations, n + m);
  EXPECT_LE((x.u - exact.u).norm(), 1e-9 * exact.u.norm());
  EXPECT_LE((x.p - exact.p).norm(), 1e-9 * exact.p.norm());
  EXPECT_EQ(x.u[0], 0);
  EXPECT_EQ(x.u[7], 0);
}

}  // namespace
}  // namespace springproof::saddle_point_test
