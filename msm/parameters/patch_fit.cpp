#include "msm/parameters/patch_fit.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "msm/algebra/krylov.h"

namespace springproof {
namespace {

constexpr int moments = 10;  // of a symmetric tensor of third order: xxx yyy zzz xxy xxz yyx yyz zzx zzy xyz
// As fractions of the diagonal, one after the other: it bounds the dual where conditions contradict each other.
constexpr std::array slacks = {1e-2, 1e-3, 1e-4};
constexpr double met = 1e-6, largest_unmet = 0.03;
constexpr int most_steps = 60, most_iterations = 3000;
using Moments = Eigen::Matrix<double, moments, 1>;
using MomentBlock = Eigen::Matrix<double, moments, moments>;

/// n (x) n (x) n, each component times the root of the number of its permutations: |n|^3 = 1 is the norm.
Moments third_power(const Vec3& n) {
  const double x = n[0], y = n[1], z = n[2], a = std::sqrt(3.0);
  Moments m;
  m << x * x * x, y * y * y, z * z * z, a * x * x * y, a * x * x * z, a * y * y * x, a * y * y * z, a * z * z * x,
      a * z * z * y, std::sqrt(6.0) * x * y * z;
  return m;
}

/// d_ij A_k + d_jk A_i + d_ki A_j in the same components.
Moments traction(const Vec3& A) {
  const double x = A[0], y = A[1], z = A[2], a = std::sqrt(3.0);
  Moments m;
  m << 3 * x, 3 * y, 3 * z, a * y, a * z, a * x, a * z, a * x, a * y, 0;
  return m;
}

/// The dual problem in units of the spacing l and of G: t = k / k_0 = max(0, 1 + B^T y), B t = b.
struct PatchDual {
  const Network& network;
  double unit, slack = slacks.front();
  std::vector<Moments> column;  ///< per spring, at its node i; at j the negative
  Eigen::VectorXd b, diagonal;

  PatchDual(const Network& n, const NodalVectors& area)
      : network(n),
        unit(std::cbrt(n.volume.sum() / static_cast<double>((n.volume.array() > 0).count()))),
        b(Eigen::VectorXd::Zero(moments * n.nodes())),
        diagonal(Eigen::VectorXd::Zero(moments * n.nodes())) {
    const double c = 15 * n.volume.sum() / std::pow(unit, 3) / static_cast<double>(n.springs.size());
    for (const Spring& s : n.springs) {
      const Vec3 along = (n.X.row(s.j) - n.X.row(s.i)).transpose() / s.rest_length;
      column.push_back(c * unit / s.rest_length * third_power(along));
    }
    for (int node = 0; node < n.nodes(); ++node)
      b.segment<moments>(moments * n.master(node)) -= traction(area.row(node).transpose() / (unit * unit));
  }

  int row(int node) const { return moments * network.master(node); }

  /// k_0 [N/m] of a spring for G = 1 Pa.
  double guess(std::size_t s) const { return column[s].norm() * unit * unit / network.springs[s].rest_length; }

  /// B t.
  void sum(const Eigen::VectorXd& t, Eigen::VectorXd& r) const {
    r.setZero(b.size());
    for (std::size_t s = 0; s < column.size(); ++s) {
      if (t[s] == 0) continue;
      const Moments force = t[s] * column[s];
      r.segment<moments>(row(network.springs[s].i)) += force;
      r.segment<moments>(row(network.springs[s].j)) -= force;
    }
  }

  /// B^T y of a spring.
  double difference(const Eigen::VectorXd& y, std::size_t s) const {
    const Spring& spring = network.springs[s];
    return column[s].dot(y.segment<moments>(row(spring.i)) - y.segment<moments>(row(spring.j)));
  }

  Eigen::VectorXd factors(const Eigen::VectorXd& y) const {
    Eigen::VectorXd t(column.size());
    for (std::size_t s = 0; s < column.size(); ++s) t[s] = std::max(0.0, 1 + difference(y, s));
    return t;
  }

  /// What is to be minimised; its gradient is B t - b + slack D y.
  double objective(const Eigen::VectorXd& y, const Eigen::VectorXd& t) const {
    return t.squaredNorm() / 2 - b.dot(y) + slack / 2 * y.dot(diagonal.cwiseProduct(y));
  }

  /// The nodes' blocks of B B^T over the springs with t > 0.
  std::vector<MomentBlock> blocks(const Eigen::VectorXd& t) const {
    std::vector<MomentBlock> block(network.nodes(), MomentBlock::Zero());
    for (std::size_t s = 0; s < column.size(); ++s) {
      if (!(t[s] > 0)) continue;
      const MomentBlock square = column[s] * column[s].transpose();
      block[network.master(network.springs[s].i)] += square;
      block[network.master(network.springs[s].j)] += square;
    }
    return block;
  }

  /// Solves (B P B^T + slack D) d = r, P the springs with t > 0.  Returns the number of iterations.
  int solve(const Eigen::VectorXd& t, const Eigen::VectorXd& r, double tolerance, Eigen::VectorXd& d) const {
    std::vector<MomentBlock> inverse = blocks(t);
    for (int n = 0; n < network.nodes(); ++n) {
      inverse[n].diagonal() += slack * diagonal.segment<moments>(moments * n);
      inverse[n] = inverse[n].ldlt().solve(MomentBlock::Identity()).eval();
    }
    Eigen::VectorXd change(t.size());
    const Operator normal = [&](const Eigen::VectorXd& y, Eigen::VectorXd& out) {
      for (std::size_t s = 0; s < column.size(); ++s) change[s] = t[s] > 0 ? difference(y, s) : 0;
      sum(change, out);
      out += slack * diagonal.cwiseProduct(y);
    };
    const Operator jacobi = [&](const Eigen::VectorXd& in, Eigen::VectorXd& out) {
      out.resize(in.size());
      for (int n = 0; n < network.nodes(); ++n)
        out.segment<moments>(moments * n) = inverse[n] * in.segment<moments>(moments * n);
    };
    d = Eigen::VectorXd::Zero(r.size());
    return conjugate_gradients(normal, jacobi, r, tolerance, most_iterations, d).iterations;
  }
};

/// Largest and mean unmet condition of a node, of that of a plane face.
void measure_patch(const PatchDual& dual, const Eigen::VectorXd& t, PatchFit& fit) {
  const double of_face = traction(Vec3::UnitZ()).norm();
  Eigen::VectorXd r;
  dual.sum(t, r);
  r -= dual.b;
  fit.mean_residual = r.norm() / std::sqrt(r.size() / static_cast<double>(moments)) / of_face;
  for (int n = 0; n < dual.network.nodes(); ++n)
    fit.residual = std::max(fit.residual, r.segment<moments>(moments * n).norm() / of_face);
}

Eigen::VectorXd minimise(PatchDual& dual, PatchFit& fit) {
  Eigen::VectorXd t = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(dual.column.size()));
  const std::vector<MomentBlock> all = dual.blocks(t);
  for (int n = 0; n < dual.network.nodes(); ++n)
    dual.diagonal.segment<moments>(moments * n).setConstant(std::max(1e-6, all[n].trace() / moments));
  Eigen::VectorXd y = Eigen::VectorXd::Zero(dual.b.size()), d, gradient, y_new, t_new;
  const double scale = traction(Vec3::UnitZ()).norm() * std::sqrt(dual.network.nodes());
  for (const double slack : slacks) {
    dual.slack = slack;
    double value = dual.objective(y, t);
    for (int step_number = 0; step_number < most_steps; ++step_number, ++fit.steps) {
      dual.sum(t, gradient);
      gradient += slack * dual.diagonal.cwiseProduct(y) - dual.b;
      const double size = gradient.norm() / scale;
      if (size < std::max(met, 1e-3 * slack)) break;
      fit.iterations += dual.solve(t, -gradient, std::clamp(size, 1e-4, 1e-1), d);
      const double slope = gradient.dot(d);
      double step = 1, value_new = value;
      for (; step > 1e-4; step /= 2) {
        y_new = y + step * d;
        t_new = dual.factors(y_new);
        value_new = dual.objective(y_new, t_new);
        if (value_new <= value + 1e-4 * step * slope) break;
      }
      if (!(value_new < value)) break;
      std::swap(y, y_new);
      std::swap(t, t_new);
      value = value_new;
    }
  }
  return t;
}

}  // namespace

PatchFit fit_patch(const NodalVectors& area, double shear_modulus, Network& network) {
  PatchDual dual(network, area);
  PatchFit fit;
  const Eigen::VectorXd t = minimise(dual, fit);
  measure_patch(dual, t, fit);
  fit.largest_factor = t.maxCoeff();
  if (!(fit.mean_residual < largest_unmet))
    throw std::runtime_error(
        fmt::format("springs_per_node: no spring constants hold every affine strain in equilibrium at the nodes "
                    "(mean residual {:.1e}, allowed: {:g}); choose more springs per node or more nodes",
                    fit.mean_residual, largest_unmet));
  std::vector<Spring> kept;
  for (std::size_t s = 0; s < network.springs.size(); ++s) {
    Spring spring = network.springs[s];
    spring.stiffness = shear_modulus * dual.guess(s) * t[static_cast<Eigen::Index>(s)];
    if (t[static_cast<Eigen::Index>(s)] > 1e-6) kept.push_back(spring);
  }
  fit.dropped = static_cast<int>(network.springs.size() - kept.size());
  network.springs = std::move(kept);
  return fit;
}

}  // namespace springproof
