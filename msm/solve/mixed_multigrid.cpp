#include "msm/solve/mixed_multigrid.h"

#include <stdexcept>

namespace springproof {
namespace {

constexpr double omega = 1.3;  // damping of the velocity block in a Braess-Sarazin sweep

void clear_fixed(const std::vector<char>& fixed, Eigen::VectorXd& u) {
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i]) u[i] = 0;
}

}  // namespace

MixedMultigrid::MixedMultigrid(std::vector<LatticeLevel> levels, const CellStiffness& cell, int sweeps, int inner_steps)
    : levels_(std::move(levels)), sweeps_(sweeps), inner_steps_(inner_steps) {
  if (!(cell.kappa > 0)) throw std::invalid_argument("the mixed form needs kappa > 0 (nu > 1/4)");
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const LatticeLevel& level = levels_[l];
    const double h = level.edge_ratio;
    Level d;
    d.springs = assemble(level, cell.without_volume);
    d.gradient = h * h * cell.volume_gradient;
    d.fill = Eigen::Map<const Eigen::VectorXd>(level.fill.data(), static_cast<Eigen::Index>(level.fill.size()));
    d.compliance = h * h * h * cell.volume / cell.kappa * d.fill;
    d.inverse_diagonal = (omega * d.springs.diagonal()).cwiseInverse();
    clear_fixed(level.fixed, d.inverse_diagonal);
    d.inverse_schur_diagonal = d.compliance;
    for (std::size_t c = 0; c < level.cells.size(); ++c)
      for (int n = 0; n < 8; ++n)
        for (int a = 0; a < 3; ++a) {
          const double b = d.fill[c] * d.gradient[3 * n + a];
          d.inverse_schur_diagonal[c] += b * b * d.inverse_diagonal[3 * level.cells[c][n] + a];
        }
    d.inverse_schur_diagonal = d.inverse_schur_diagonal.cwiseInverse();
    data_.push_back(std::move(d));
    // Power iteration, with a margin since it approaches from below.
    Eigen::VectorXd q(level.cells.size()), y;
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = 1 + 0.5 * ((i * 7919) % 13 - 6) / 6.0;
    double bound = 1;
    for (int k = 0; k < 20; ++k) {
      q.normalize();
      schur(l, q, y);
      q = data_[l].inverse_schur_diagonal.cwiseProduct(y);
      bound = q.norm();
    }
    data_[l].schur_bound = 1.15 * bound;
  }
  if (!coarsest_.factor(assemble(levels_.back(), cell.total), levels_.back().fixed))
    throw std::runtime_error("the coarsest lattice is singular: the body is not held, or the model has zero-energy modes");
}

void MixedMultigrid::divergence(std::size_t l, const Eigen::VectorXd& u, Eigen::VectorXd& p) const {
  const LatticeLevel& level = levels_[l];
  const Level& d = data_[l];
  p.resize(level.cells.size());
  for (std::size_t c = 0; c < level.cells.size(); ++c) {
    double sum = 0;
    for (int n = 0; n < 8; ++n) sum += d.gradient.segment<3>(3 * n).dot(u.segment<3>(3 * level.cells[c][n]));
    p[c] = d.fill[c] * sum;
  }
}

void MixedMultigrid::add_gradient(std::size_t l, const Eigen::VectorXd& p, Eigen::VectorXd& u) const {
  const LatticeLevel& level = levels_[l];
  const Level& d = data_[l];
  for (std::size_t c = 0; c < level.cells.size(); ++c) {
    const double w = d.fill[c] * p[c];
    for (int n = 0; n < 8; ++n) u.segment<3>(3 * level.cells[c][n]) += w * d.gradient.segment<3>(3 * n);
  }
}

void MixedMultigrid::schur(std::size_t l, const Eigen::VectorXd& q, Eigen::VectorXd& y) const {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * levels_[l].nodes);
  add_gradient(l, q, u);
  u = u.cwiseProduct(data_[l].inverse_diagonal);
  divergence(l, u, y);
  y += data_[l].compliance.cwiseProduct(q);
}

void MixedMultigrid::solve_schur(std::size_t l, const Eigen::VectorXd& b, Eigen::VectorXd& q) const {
  const Level& d = data_[l];
  q.setZero(b.size());
  Eigen::VectorXd r = b, z = Eigen::VectorXd::Zero(b.size()), Sz;
  for (int k = 1; k <= inner_steps_; ++k) {  // fourth-kind Chebyshev
    z = (2.0 * k - 3) / (2.0 * k + 1) * z +
        (8.0 * k - 4) / ((2.0 * k + 1) * d.schur_bound) * d.inverse_schur_diagonal.cwiseProduct(r);
    q += z;
    if (k == inner_steps_) break;
    schur(l, z, Sz);
    r -= Sz;
  }
}

void MixedMultigrid::residual(std::size_t l, const Pair& b, const Pair& x, Pair& r) const {
  data_[l].springs.multiply(x.u, r.u);
  add_gradient(l, x.p, r.u);
  r.u = b.u - r.u;
  clear_fixed(levels_[l].fixed, r.u);
  divergence(l, x.u, r.p);
  r.p = b.p - r.p + data_[l].compliance.cwiseProduct(x.p);
}

void MixedMultigrid::sweep(std::size_t l, const Pair& b, bool from_zero, Pair& x) const {
  Pair r;
  if (from_zero)
    r = b;
  else
    residual(l, b, x, r);
  const Eigen::VectorXd d = data_[l].inverse_diagonal.cwiseProduct(r.u);
  Eigen::VectorXd rhs, q;
  divergence(l, d, rhs);
  rhs -= r.p;
  solve_schur(l, rhs, q);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(d.size());
  add_gradient(l, q, gradient);
  x.u += d - data_[l].inverse_diagonal.cwiseProduct(gradient);
  x.p += q;
}

void MixedMultigrid::cycle(std::size_t l, const Pair& b, Pair& x) const {
  const LatticeLevel& level = levels_[l];
  x.u.setZero(3 * level.nodes);
  x.p.setZero(static_cast<Eigen::Index>(level.cells.size()));
  if (l + 1 == levels_.size()) {
    // Eliminate p: (K_s + B^T C^-1 B) u = f + B^T C^-1 g, p = C^-1 (B u - g).
    const Eigen::VectorXd stiffness = data_[l].compliance.cwiseInverse();
    Eigen::VectorXd rhs = b.u;
    add_gradient(l, stiffness.cwiseProduct(b.p), rhs);
    coarsest_.solve(rhs, x.u);
    Eigen::VectorXd Bu;
    divergence(l, x.u, Bu);
    x.p = stiffness.cwiseProduct(Bu - b.p);
    return;
  }
  for (int s = 0; s < sweeps_; ++s) sweep(l, b, s == 0, x);
  Pair r, coarse_r, coarse_x;
  residual(l, b, x, r);
  const LatticeLevel& below = levels_[l + 1];
  below.restrict_to(r.u, level.fixed, coarse_r.u);
  coarse_r.p.setZero(static_cast<Eigen::Index>(below.cells.size()));
  for (std::size_t c = 0; c < level.cells.size(); ++c) coarse_r.p[below.parent[c]] += r.p[c];
  cycle(l + 1, coarse_r, coarse_x);
  Eigen::VectorXd correction;
  below.prolongate(coarse_x.u, level.fixed, correction);
  x.u += correction;
  for (std::size_t c = 0; c < level.cells.size(); ++c) x.p[c] += coarse_x.p[below.parent[c]];
  for (int s = 0; s < sweeps_; ++s) sweep(l, b, false, x);
}

void MixedMultigrid::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  const Eigen::Index n = 3 * levels_[0].nodes;
  Pair zero{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(x.size() - n)}, r;
  residual(0, zero, {x.head(n), x.tail(x.size() - n)}, r);
  y.resize(x.size());
  y << -r.u, -r.p;
}

void MixedMultigrid::precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  const Eigen::Index n = 3 * levels_[0].nodes;
  Pair x;
  cycle(0, {r.head(n), r.tail(r.size() - n)}, x);
  z.resize(r.size());
  z << x.u, x.p;
}

Eigen::VectorXd MixedMultigrid::force(const Eigen::VectorXd& u, const Eigen::VectorXd& p) const {
  Eigen::VectorXd f;
  data_[0].springs.multiply(u, f);
  add_gradient(0, p, f);
  return f;
}

Eigen::VectorXd MixedMultigrid::volume_change(const Eigen::VectorXd& u) const {
  Eigen::VectorXd p;
  divergence(0, u, p);
  return p;
}

}  // namespace springproof
