#include "msm/parameters/patch_fit.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "msm/algebra/krylov.h"
#include "msm/parameters/patch_conditions.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

// As fractions of the diagonal, one after the other: it bounds the dual where conditions contradict each other.
constexpr std::array slacks = {1e-2, 1e-3, 1e-4, 1e-5};
constexpr double contradiction = 0.03;  // unmet with a slack of 1e-4, of the condition of a plane face
constexpr double barrier = 0.3;         // mu
constexpr double met = 1e-6, largest_unmet = 0.03;
constexpr int most_steps = 60, most_iterations = 3000;
using MomentBlock = Eigen::Matrix<double, patch_moments, patch_moments>;
using MomentBlockF = Eigen::Matrix<float, patch_moments, patch_moments>;
using PatchMomentsF = Eigen::Matrix<float, patch_moments, 1>;

/// The conditions of a node in a vector of all.
auto at(Eigen::VectorXd& v, int node) { return v.segment<patch_moments>(patch_moments * node); }
auto at(const Eigen::VectorXd& v, int node) { return v.segment<patch_moments>(patch_moments * node); }

/// The dual problem in units of the spacing l and of G: t = k / k_0, B t = b; t - mu^2 / t = 1 - mu^2 + B^T y.
struct PatchDual {
  const Network& network;
  double unit;
  std::vector<PatchColumn> column;  ///< per spring
  Eigen::VectorXd b, diagonal, slack;
  KillingSpace smooth;  ///< not of periodic networks, on which such fields are not periodic

  PatchDual(const Network& n, const NodalVectors& area)
      : network(n),
        unit(std::cbrt(n.volume.sum() / static_cast<double>((n.volume.array() > 0).count()))),
        b(Eigen::VectorXd::Zero(patch_moments * n.nodes())),
        diagonal(Eigen::VectorXd::Zero(patch_moments * n.nodes())),
        slack(Eigen::VectorXd::Constant(n.nodes(), slacks.front())),
        smooth(n.image_of.empty() ? n.X : NodalVectors(0, 3), unit) {
    const double c = 15 * n.volume.sum() / std::pow(unit, 3) / static_cast<double>(n.springs.size());
    for (const Spring& s : n.springs) {
      const Vec3 along = (n.X.row(s.j) - n.X.row(s.i)).transpose() / s.rest_length;
      column.push_back(
          {n.master(s.i), n.master(s.j), c * unit / s.rest_length * symmetric_product(along, along, along)});
    }
    for (int node = 0; node < n.nodes(); ++node)
      at(b, n.master(node)) -= patch_traction(area.row(node).transpose() / (unit * unit));
    const std::vector<MomentBlock> all = blocks(Eigen::VectorXd::Ones(static_cast<Eigen::Index>(column.size())));
    for (int node = 0; node < n.nodes(); ++node)
      at(diagonal, node).setConstant(std::max(1e-6, all[node].trace() / patch_moments));
  }

  /// k_0 [N/m] of a spring for G = 1 Pa.
  double guess(std::size_t s) const { return column[s].column.norm() * unit * unit / network.springs[s].rest_length; }

  /// B t.
  Eigen::VectorXd sum(const Eigen::VectorXd& t) const {
    Eigen::VectorXd r = Eigen::VectorXd::Zero(b.size());
    for (std::size_t s = 0; s < column.size(); ++s) {
      const PatchMoments force = t[static_cast<Eigen::Index>(s)] * column[s].column;
      at(r, column[s].i) += force;
      at(r, column[s].j) -= force;
    }
    return r;
  }

  Eigen::VectorXd factors(const Eigen::VectorXd& y) const {
    Eigen::VectorXd t(static_cast<Eigen::Index>(column.size()));
    for (std::size_t s = 0; s < column.size(); ++s) {
      const double v = 1 - barrier * barrier + column[s].column.dot(at(y, column[s].i) - at(y, column[s].j));
      const double root = std::sqrt(v * v + 4 * barrier * barrier);
      t[static_cast<Eigen::Index>(s)] = v > 0 ? (v + root) / 2 : 2 * barrier * barrier / (root - v);
    }
    return t;
  }

  /// Slack times its diagonal.
  Eigen::VectorXd weight() const {
    Eigen::VectorXd w = diagonal;
    for (int n = 0; n < network.nodes(); ++n) at(w, n) *= slack[n];
    return w;
  }

  /// What is to be minimised.
  double objective(const Eigen::VectorXd& y, const Eigen::VectorXd& t) const {
    return t.squaredNorm() / 2 + barrier * barrier * t.array().log().sum() - b.dot(y) +
           y.dot(weight().cwiseProduct(y)) / 2;
  }

  Eigen::VectorXd gradient(const Eigen::VectorXd& y, const Eigen::VectorXd& t) const {
    return sum(t) - b + weight().cwiseProduct(y);
  }

  /// The nodes' blocks of B W B^T.
  std::vector<MomentBlock> blocks(const Eigen::VectorXd& W) const {
    std::vector<MomentBlock> block(network.nodes(), MomentBlock::Zero());
    for (std::size_t s = 0; s < column.size(); ++s) {
      const MomentBlock square = W[static_cast<Eigen::Index>(s)] * column[s].column * column[s].column.transpose();
      block[column[s].i] += square;
      block[column[s].j] += square;
    }
    return block;
  }

  /// Solves (B W B^T + slack D) d = r, W = dt / d(B^T y), roughly: the matrix is kept in single precision.
  void solve(const Eigen::VectorXd& t, const Eigen::VectorXd& r, double tolerance, Eigen::VectorXd& d) {
    const Eigen::VectorXd W = t.array().square() / (t.array().square() + barrier * barrier), D = weight();
    std::vector<PatchMomentsF> root(column.size());  // columns of B W^(1/2)
    for (std::size_t s = 0; s < column.size(); ++s)
      root[s] = (std::sqrt(W[static_cast<Eigen::Index>(s)]) * column[s].column).cast<float>();
    std::vector<MomentBlock> block = blocks(W);
    std::vector<MomentBlockF> inverse(block.size());
    for (int n = 0; n < network.nodes(); ++n) {
      block[n].diagonal() += at(D, n);
      inverse[n] = block[n].ldlt().solve(MomentBlock::Identity()).cast<float>();
    }
    smooth.factor(column, W, D);
    Eigen::VectorXf single, sum;
    const Operator normal = [&](const Eigen::VectorXd& y, Eigen::VectorXd& out) {
      single = y.cast<float>();
      sum.setZero(y.size());
      for (std::size_t s = 0; s < column.size(); ++s) {
        const auto i = single.segment<patch_moments>(patch_moments * column[s].i);
        const auto j = single.segment<patch_moments>(patch_moments * column[s].j);
        const PatchMomentsF force = root[s].dot(i - j) * root[s];
        sum.segment<patch_moments>(patch_moments * column[s].i) += force;
        sum.segment<patch_moments>(patch_moments * column[s].j) -= force;
      }
      out = sum.cast<double>() + D.cwiseProduct(y);
    };
    const Operator precondition = [&](const Eigen::VectorXd& in, Eigen::VectorXd& out) {
      single = in.cast<float>();
      sum.resize(in.size());
      for (int n = 0; n < network.nodes(); ++n)
        sum.segment<patch_moments>(patch_moments * n).noalias() =
            inverse[n] * single.segment<patch_moments>(patch_moments * n);
      smooth.add(single, sum);
      out = sum.cast<double>();
    };
    d = Eigen::VectorXd::Zero(r.size());
    conjugate_gradients(normal, precondition, r, tolerance, most_iterations, d);
  }
};

const double of_face = patch_traction(Vec3::UnitZ()).norm();

/// Root mean square over the nodes of the unmet condition, of that of a plane face.
double mean_residual(const PatchDual& dual, const Eigen::VectorXd& t) {
  return (dual.sum(t) - dual.b).norm() / std::sqrt(dual.network.nodes()) / of_face;
}

/// "near (0.1, 0.02, 0) m": the node whose condition is farthest from being met.
std::string worst_place(const PatchDual& dual, const Eigen::VectorXd& t) {
  const Eigen::VectorXd unmet = dual.sum(t) - dual.b;
  Eigen::Index worst = 0;
  Eigen::Map<const Eigen::Matrix<double, patch_moments, Eigen::Dynamic>>(unmet.data(), patch_moments,
                                                                         dual.network.nodes())
      .colwise()
      .norm()
      .maxCoeff(&worst);
  const Eigen::RowVector3d at = dual.network.X.row(worst);
  return fmt::format("near ({:.4g}, {:.4g}, {:.4g}) m", at[0], at[1], at[2]);
}

/// Newton's method with the present slack.
void minimise(PatchDual& dual, double tolerance, Eigen::VectorXd& y, Eigen::VectorXd& t) {
  double value = dual.objective(y, t);
  Eigen::VectorXd d;
  for (int steps = 0; steps < most_steps; ++steps) {
    const Eigen::VectorXd gradient = dual.gradient(y, t);
    const double size = gradient.norm() / of_face / std::sqrt(dual.network.nodes());
    progress::detail(fmt::format("fitting the springs' constants: {:.0e} of the conditions unmet", size));
    if (size < tolerance) return;
    dual.solve(t, -gradient, std::clamp(std::max(size, tolerance / size / 3), 1e-3, 1e-1), d);
    const double slope = gradient.dot(d);
    bool lower = false;
    for (double step = 1; step > 1e-4 && !lower; step /= 2) {
      const Eigen::VectorXd y_new = y + step * d, t_new = dual.factors(y_new);
      const double value_new = dual.objective(y_new, t_new);
      lower = value_new <= value + 1e-4 * step * slope && value_new < value;
      if (!lower) continue;
      y = y_new;
      t = t_new;
      value = value_new;
    }
    if (!lower) return;
  }
}

/// Lowers the slack, but not where conditions contradict each other.
Eigen::VectorXd fitted(PatchDual& dual) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(dual.b.size()), t = dual.factors(y);
  for (const double slack : slacks) {
    const Eigen::VectorXd unmet = dual.weight().cwiseProduct(y);
    for (int n = 0; n < dual.network.nodes(); ++n)
      if (slack >= 1e-4 || at(unmet, n).norm() <= contradiction * of_face) dual.slack[n] = slack;
    minimise(dual, std::max(met, slack / 10), y, t);
  }
  return t;
}

}  // namespace

void fit_patch(const NodalVectors& area, double shear_modulus, Network& network) {
  PatchDual dual(network, area);
  const Eigen::VectorXd t = fitted(dual);
  const double unmet = mean_residual(dual, t);
  if (!(unmet < largest_unmet))
    throw std::runtime_error(fmt::format(
        "springs_per_node: no spring constants hold every affine strain in equilibrium at the {} nodes "
        "(mean residual {:.1e}, allowed: {:g}; worst {}); choose more nodes (smaller cells: thin parts need "
        "three across) or more springs per node",
        network.nodes(), unmet, largest_unmet, worst_place(dual, t)));
  for (std::size_t s = 0; s < network.springs.size(); ++s)
    network.springs[s].stiffness = shear_modulus * dual.guess(s) * t[static_cast<Eigen::Index>(s)];
}

}  // namespace springproof
