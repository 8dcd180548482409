#include "comparisons/identify/least_squares.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace springproof {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Indices = std::vector<Index>;

constexpr int most_iterations = 30, most_dampings = 8;
constexpr double smallest_change = 0.01;  // of a residual, in standard uncertainties
constexpr double first_damping = 1e-2, damping_factor = 10;
constexpr double least_told = 1e-9;  // singular value

/// The parameters that a step may change: not those at a bound that it would cross.
Indices free_parameters(const BoundedFit& p, const VectorXd& at, const VectorXd& slope) {
  Indices free;
  for (Index i = 0; i < at.size(); ++i)
    if (!(at[i] <= p.lower[i] && slope[i] > 0) && !(at[i] >= p.upper[i] && slope[i] < 0)) free.push_back(i);
  return free;
}

/// A step of the free parameters, the others at rest, that ends between the bounds.
VectorXd step_of(const BoundedFit& p, const VectorXd& at, const MatrixXd& J, const VectorXd& r, double damping) {
  const VectorXd slope = J.transpose() * r;
  const Indices free = free_parameters(p, at, slope);
  if (free.empty()) return VectorXd::Zero(at.size());  // all are at a bound
  const MatrixXd of_free = J(Eigen::all, free);
  MatrixXd A = of_free.transpose() * of_free;
  A.diagonal() *= 1 + damping;
  VectorXd step = VectorXd::Zero(at.size());
  const VectorXd downhill = -slope(free), of_step = A.completeOrthogonalDecomposition().solve(downhill);
  step(free) = of_step;
  return (at + step).cwiseMax(p.lower).cwiseMin(p.upper) - at;
}

/// The problem of some of the parameters; the others are as in `all`.
BoundedFit part_of(const BoundedFit& p, const Indices& free, const VectorXd& all) {
  const BoundedFit::Residuals of_free = [&p, free, all](const VectorXd& some) {
    VectorXd parameters = all;
    parameters(free) = some;
    return p.residuals(parameters);
  };
  return {of_free, all(free), p.lower(free), p.upper(free), p.step(free)};
}

Indices not_held(const std::vector<bool>& held) {
  Indices free;
  for (std::size_t i = 0; i < held.size(); ++i)
    if (!held[i]) free.push_back(static_cast<Index>(i));
  return free;
}

/// Which to hold, by the Jacobian of all: one after the other until the rest is told.
std::vector<bool> untold_of(const MatrixXd& J, const VectorXd& range) {
  std::vector<bool> held(static_cast<std::size_t>(J.cols()), false);
  for (Indices free = not_held(held); free.size() > 1; free = not_held(held)) {
    const auto number = untold(certainty_of(J(Eigen::all, free)), range(free));
    if (!number) break;
    held[static_cast<std::size_t>(free[static_cast<std::size_t>(*number)])] = true;
  }
  return held;
}

/// Of the free parameters, from `at` on; the others stay at their start.
LeastSquaresFit fit_of_free(const BoundedFit& p, const std::vector<bool>& held, const VectorXd& at) {
  const Indices free = not_held(held);
  VectorXd from = p.start;
  from(free) = at(free);
  LeastSquaresFit found = fit(part_of(p, free, from));
  VectorXd all = from;
  all(free) = found.parameters;
  found.parameters = all;
  return found;
}

}  // namespace

VectorXd beside(const BoundedFit& p, const VectorXd& at, Index i) {
  VectorXd moved = at;
  moved[i] = std::max(at[i] + (at[i] + p.step[i] <= p.upper[i] ? p.step[i] : -p.step[i]), p.lower[i]);
  return moved;
}

std::optional<MatrixXd> jacobian_of(const BoundedFit& p, const VectorXd& at, const VectorXd& r) {
  MatrixXd J(r.size(), at.size());
  for (Index i = 0; i < at.size(); ++i) {
    const VectorXd moved = beside(p, at, i);
    const std::optional<VectorXd> there = p.residuals(moved);
    if (!there) return {};
    J.col(i) = (*there - r) / (moved[i] - at[i]);
  }
  return J;
}

LeastSquaresFit fit(const BoundedFit& p) {
  LeastSquaresFit out{p.start, {}, 0, false, ""};
  std::optional<VectorXd> r = p.residuals(p.start);
  out.message = "the model has no result at the start";
  if (!r) return out;
  out.residuals = *r;
  double damping = 0;
  for (; out.iterations < most_iterations; ++out.iterations) {
    const std::optional<MatrixXd> J = jacobian_of(p, out.parameters, out.residuals);
    out.message = "the model has no result beside the parameters that were found";
    if (!J) return out;
    bool better = false;
    // Of the whole step: a damped one is small wherever there is no result beyond.
    out.converged = (*J * step_of(p, out.parameters, *J, out.residuals, 0)).cwiseAbs().maxCoeff() < smallest_change;
    if (out.converged) damping = 0;
    for (int tries = 0; tries < most_dampings && !better; ++tries) {
      const VectorXd step = step_of(p, out.parameters, *J, out.residuals, damping);
      r = p.residuals(out.parameters + step);
      better = r && r->squaredNorm() <= out.residuals.squaredNorm();
      if (better) {
        out.parameters += step;
        out.residuals = *r;
      }
      if (out.converged) break;
      damping = better ? damping / damping_factor : std::max(damping * damping_factor, first_damping);
    }
    if (damping < first_damping) damping = 0;
    out.message = out.converged ? "" : "no step makes the residuals smaller";
    if (out.converged || !better) return out;
  }
  out.message = "the parameters have not come to rest";
  return out;
}

Certainty certainty_of(const MatrixXd& J) {
  const Eigen::JacobiSVD<MatrixXd> svd(J, Eigen::ComputeThinV);
  const VectorXd u = svd.singularValues().cwiseMax(least_told).cwiseInverse();
  const Index n = u.size();
  Certainty out;
  out.directions = svd.matrixV().rowwise().reverse();
  out.along = u.reverse();
  const MatrixXd root = svd.matrixV() * u.asDiagonal();
  out.covariance = root * root.transpose();
  out.u = out.covariance.diagonal().cwiseSqrt();
  out.correlation = out.covariance.cwiseQuotient(out.u * out.u.transpose());
  for (Index i = 0; i < n; ++i) out.correlation(i, i) = 1;
  return out;
}

std::optional<Index> untold(const Certainty& c, const VectorXd& range) {
  const VectorXd share = c.u.cwiseQuotient(range);
  std::optional<Index> worst;
  for (Index i = 0; i < share.size(); ++i)
    if (share[i] > most_of_range && (!worst || share[i] > share[*worst])) worst = i;
  return worst;
}

HeldFit fit_what_is_told(const BoundedFit& p) {
  constexpr int most_rounds = 3;
  HeldFit out{{p.start, {}, 0, false, "the model has no result at the start"}, {}, {}};
  out.held.assign(static_cast<std::size_t>(p.start.size()), false);
  const std::optional<VectorXd> r = p.residuals(p.start);
  if (!r) return out;
  out.fit.message = "the model has no result beside the start";
  std::optional<MatrixXd> J = jacobian_of(p, p.start, *r);
  int iterations = 0;
  for (int round = 0; J && round < most_rounds; ++round) {
    const std::vector<bool> held = untold_of(*J, p.upper - p.lower);
    if (round > 0 && held == out.held) break;
    out.held = held;
    out.fit = fit_of_free(p, held, out.fit.parameters);
    out.fit.iterations = iterations += out.fit.iterations;
    if (!out.fit.converged) return out;
    J = jacobian_of(p, out.fit.parameters, out.fit.residuals);
    out.jacobian = J.value_or(MatrixXd());
  }
  return out;
}

}  // namespace springproof
