#include "msm/multigrid/network_smoother.h"

#include <Eigen/Dense>
#include <cmath>

#include "msm/algebra/noise.h"
#include "msm/kernels/list_stiffness.h"
#include "msm/laws/capabilities.h"
#include "msm/multigrid/chebyshev.h"

namespace springproof {
namespace {

constexpr int degree = 3;
constexpr int power_steps = 15;
constexpr double power_margin = 1.1;  // safety factor for unconverged power iterations

/// Inverse of a node's block, without the rows and columns of its fixed unknowns.
Eigen::Matrix3d inverse_block(Eigen::Matrix3d block, const char* fixed) {
  for (int d = 0; d < 3; ++d)
    if (fixed[d]) {
      block.row(d).setZero();
      block.col(d).setZero();
      block(d, d) = 1;
    }
  Eigen::Matrix3d inverse = block.inverse();
  for (int d = 0; d < 3; ++d)
    if (fixed[d]) inverse(d, d) = 0;
  return inverse;
}

/// Pseudo-random start vector of power iterations.
Eigen::VectorXd rough(Eigen::Index size) {
  Eigen::VectorXd v(size);
  fill_with_noise(v);
  return v;
}

class ListSmoother : public NetworkSmoother {
 public:
  ListSmoother(const MassSpringModel& model, const std::vector<char>& fixed)
      : unit_(mean_stiffness(model.network)),
        blocks_(std::make_shared<SpringBlocks>(model.network)),
        exact_(model, blocks_),
        K_(exact_, unit_),
        z_(blocks_->order.size(), Padded<float>{}) {
    x_ = r_ = y_ = z_;
    std::vector<Eigen::Matrix3d> block = exact_.node_blocks();
    inverse_.resize(3 * z_.size());
    for (std::size_t p = 0; p < z_.size(); ++p) {
      const Eigen::Matrix3d inverse = unit_ * inverse_block(block[p], &fixed[3 * blocks_->order[p]]);
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 3; ++d) inverse_[3 * p + a].v[d] = static_cast<float>(inverse(a, d));
    }
    // For springs alone k (n . du)^2 <= 2 k ((n . u_i)^2 + (n . u_j)^2).
    largest_eigenvalue_ = dispersion_of(model) ? power_margin * power_estimate() : 2;
  }

  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const override { exact_.multiply(x, y); }
  Eigen::VectorXd diagonal() const override { return exact_.diagonal(); }

  void before(const Eigen::VectorXd& b, Eigen::VectorXd& r) override {
    const double largest = b.lpNorm<Eigen::Infinity>();
    scale_ = largest > 0 ? largest : 1;
    by_place(*blocks_, b.data(), 1 / scale_, r_);
    clear(x_);
    clear(y_);
    for (int k = 1; k <= degree; ++k) {
      smooth(ChebyshevStep(k, largest_eigenvalue_));
      K_.add(z_.data(), y_.data());
    }
    for (std::size_t p = 0; p < r_.size(); ++p)
      for (int d = 0; d < 3; ++d) z_[p].v[d] = r_[p].v[d] - y_[p].v[d];
    r.resize(b.size());
    by_node(*blocks_, z_, scale_, r.data());
  }

  void after(const Eigen::VectorXd& correction, Eigen::VectorXd& x) override {
    by_place(*blocks_, correction.data(), unit_ / scale_, z_);
    for (std::size_t p = 0; p < x_.size(); ++p)
      for (int d = 0; d < 3; ++d) x_[p].v[d] += z_[p].v[d];
    K_.add(z_.data(), y_.data());  // in addition to K z from before()
    for (int k = 1; k <= degree; ++k) {
      smooth(ChebyshevStep(k, largest_eigenvalue_));
      if (k < degree) K_.add(z_.data(), y_.data());
    }
    x.resize(correction.size());
    by_node(*blocks_, x_, scale_ / unit_, x.data());
  }

 private:
  static double mean_stiffness(const Network& network) {
    double sum = 0;
    for (const Spring& s : network.springs) sum += s.stiffness;
    return sum / static_cast<double>(network.springs.size());
  }

  static void clear(std::vector<Padded<float>>& v) { std::fill(v.begin(), v.end(), Padded<float>{}); }

  /// r -= y, z = previous z + step D^-1 r, x += z, y = 0.
  void smooth(const ChebyshevStep& by) {
    K_.kernels().smooth({static_cast<long>(z_.size()), static_cast<float>(by.previous), static_cast<float>(by.step),
                         inverse_.data(), y_.data(), r_.data(), z_.data(), x_.data()});
  }

  double power_estimate() {
    by_place(*blocks_, rough(static_cast<Eigen::Index>(3 * z_.size())).data(), 1, r_);
    clear(y_);
    smooth(ChebyshevStep(0.0, 1.0));
    double estimate = 1;
    for (int i = 0; i < power_steps; ++i) {
      double square = 0;
      for (const Padded<float>& z : z_)
        for (float value : z.v) square += value * value;
      const float factor = static_cast<float>(1 / std::sqrt(square));
      for (Padded<float>& z : z_)
        for (float& value : z.v) value *= factor;
      clear(r_);
      K_.add(z_.data(), y_.data());
      smooth(ChebyshevStep(0.0, -1.0));  // z = D^-1 y
      square = 0;
      for (const Padded<float>& z : z_)
        for (float value : z.v) square += value * value;
      estimate = std::sqrt(square);
    }
    return estimate;
  }

  double unit_;
  std::shared_ptr<const SpringBlocks> blocks_;
  ListStiffness<double> exact_;
  ListStiffness<float> K_;  ///< in units of the mean spring, against overflow in single precision
  std::vector<Padded<float>> inverse_, z_, x_, r_, y_;
  double largest_eigenvalue_ = 0, scale_ = 1;
};

class AssembledSmoother : public NetworkSmoother {
 public:
  AssembledSmoother(const MassSpringModel& model, const std::vector<char>& fixed)
      : K_(tangent(model, model.network.X)), inverse_(K_.node_blocks()) {
    for (std::size_t n = 0; n < inverse_.size(); ++n) inverse_[n] = inverse_block(inverse_[n], &fixed[3 * n]);
    Eigen::VectorXd v, Kv = rough(static_cast<Eigen::Index>(fixed.size()));
    for (int i = 0; i < power_steps; ++i) {
      block_jacobi(Kv, v);
      v.normalize();
      K_.multiply(v, Kv);
    }
    block_jacobi(Kv, v);
    largest_eigenvalue_ = power_margin * v.norm();
  }

  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const override { K_.multiply(x, y); }
  Eigen::VectorXd diagonal() const override { return K_.diagonal(); }

  void before(const Eigen::VectorXd& b, Eigen::VectorXd& r) override {
    x_.setZero(b.size());
    r_ = b;
    smooth(true);
    r = r_;
  }

  void after(const Eigen::VectorXd& correction, Eigen::VectorXd& x) override {
    x_ += correction;
    K_.multiply(correction, Kz_);
    r_ -= Kz_;
    smooth(false);
    x = x_;
  }

 private:
  void smooth(bool update_residual) {
    z_.setZero(r_.size());
    for (int k = 1; k <= degree; ++k) {
      block_jacobi(r_, Dr_);
      const ChebyshevStep by(k, largest_eigenvalue_);
      z_ = by.previous * z_ + by.step * Dr_;
      x_ += z_;
      if (k == degree && !update_residual) return;
      K_.multiply(z_, Kz_);
      r_ -= Kz_;
    }
  }

  void block_jacobi(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
    z.resize(r.size());
    for (std::size_t n = 0; n < inverse_.size(); ++n) z.segment<3>(3 * n) = inverse_[n] * r.segment<3>(3 * n);
  }

  Tangent K_;
  std::vector<Eigen::Matrix3d> inverse_;
  double largest_eigenvalue_ = 0;
  Eigen::VectorXd x_, r_, z_, Dr_, Kz_;
};

}  // namespace

std::unique_ptr<NetworkSmoother> network_smoother(const MassSpringModel& model, const std::vector<char>& fixed) {
  if (can(model, Capability::list_stiffness)) return std::make_unique<ListSmoother>(model, fixed);
  return std::make_unique<AssembledSmoother>(model, fixed);
}

}  // namespace springproof
