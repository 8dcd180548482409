#include "msm/multigrid/cut_mixed_multigrid.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "msm/multigrid/multigrid.h"

namespace springproof {
namespace {

constexpr int sweeps_of_cut_cells = 3;    // before and after the coarser lattice
constexpr double anchors_of_cycle = 0.3;  // of the anchors' stiffness: point smoothers cope badly with all of it
constexpr double relaxed = 1.8;           // largest eigenvalue of the damped D K_s

/// Without the volume term.
AveragedSprings springs_alone(AveragedSprings law) {
  law.lame_lambda = law.shear_modulus;
  return law;
}

}  // namespace

CutMixedMultigrid::CutMixedMultigrid(const MassSpringModel& model, const std::vector<char>& fixed)
    : nodes_(model.network, fixed),
      scaled_nodes_(nodes_),
      network_(model.network),
      lattice_(cut_levels(model.network, nodes_)) {
  const AveragedSprings& law = *averaged_springs_of(model);
  const AveragedSprings springs = springs_alone(law);
  const Network& network = model.network;
  const double l = network.cell_edge, kappa = (law.lame_lambda - law.shear_modulus) / law.shear_modulus;
  unit_ = law.shear_modulus * l;
  for (Anchor& a : scaled_nodes_.anchors) a.stiffness /= unit_;
  chebyshev_steps_ = kappa > 1000 ? 12 : 6;
  gradient_.resize(24, static_cast<Eigen::Index>(network.cells.size()));
  compliance_.resize(gradient_.cols());
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const double h = network.edge(c) / l;
    gradient_.col(static_cast<Eigen::Index>(c)) = volume_gradient(h, network.filled[c]);
    compliance_[static_cast<Eigen::Index>(c)] = network.filled[c].fraction * h * h * h / kappa;
  }
  levels_.resize(lattice_.size());
  for (CutLevel& level : lattice_)
    for (Anchor& a : level.anchors) a.stiffness *= anchors_of_cycle;
  for (std::size_t i = 0; i < lattice_.size(); ++i) {
    const std::vector<char> fixed_here = i == 0 ? nodes_.fixed_corners() : std::vector<char>{};
    if (i + 1 == lattice_.size()) {  // the pressure is eliminated there
      take_matrix(CutMatrix<double>(law, unit_, lattice_[i], fixed_here), unit_, fixed_here, lattice_[i]);
      coarsest_.factor(lattice_[i].A.sparse());
    }
    CutMatrix<double> of_cells(springs, unit_, lattice_[i], fixed_here);
    take_matrix(of_cells, unit_, fixed_here, lattice_[i]);
    if (i == 0) K_ = std::move(of_cells);
    set_up(i, kappa);
  }
}

void CutMixedMultigrid::set_up(std::size_t l, double kappa) {
  const CutLevel& lattice = lattice_[l];
  Level& level = levels_[l];
  const std::size_t cells = lattice.cubes.size();
  const Carriers carriers = carriers_of(static_cast<int>(lattice.point.size()), lattice.carried);
  level.f = level.u = level.d = Eigen::VectorXf::Zero(lattice.unknowns());
  level.compliance = level.inverse_schur = level.g = level.p = level.Bu = level.r = level.z = level.q =
      Eigen::VectorXf::Zero(static_cast<Eigen::Index>(cells));
  level.D = lattice.D;
  const auto omega = static_cast<float>(damping(l) / relaxed);
  for (float& value : level.D) value /= omega;
  level.gradient.resize(24 * cells);
  for (std::size_t c = 0; c < cells; ++c) {
    const double h = lattice.cell_edge(c) / lattice_[0].edge;
    const Eigen::Matrix<double, 24, 1> b = volume_gradient(h, lattice.filled[c]);
    std::map<int, Vec3> row;  // with what carried corners hand back
    for (int n = 0; n < 8; ++n) {
      const int point = lattice.corners[c][n];
      const auto hand = [&](int p, double w) {
        row.try_emplace(p, Vec3::Zero()).first->second += w * b.segment<3>(3 * n);
      };
      if (carriers.empty() || carriers[point].empty()) hand(point, 1);
      if (!carriers.empty())
        for (const auto& [p, w] : carriers[point]) hand(p, w);
    }
    double sum = 0;
    for (const auto& [point, own] : row) {
      const float* D = &level.D[9 * static_cast<std::size_t>(point)];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum += own[i] * D[3 * i + j] * own[j];
    }
    for (int i = 0; i < 24; ++i) level.gradient[24 * c + i] = static_cast<float>(b[i]);
    const double C = lattice.filled[c].fraction * h * h * h / kappa;
    level.compliance[static_cast<Eigen::Index>(c)] = static_cast<float>(C);
    level.inverse_schur[static_cast<Eigen::Index>(c)] = static_cast<float>(1 / (C + sum));
  }
  bound_schur(l);
}

/// Largest eigenvalue of diag(K)^-1 K, by power iteration with a margin.
double CutMixedMultigrid::damping(std::size_t l) const {
  const CutMatrix<float>& A = lattice_[l].A;
  Eigen::VectorXf v(3 * A.rows()), y(3 * A.rows()), residuals(3 * A.rows());
  const Eigen::VectorXf zero = Eigen::VectorXf::Zero(v.size());
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = static_cast<float>((i * 7919) % 13 - 6) / 6.0f;
  double bound = 1;
  for (int k = 0; k < 15; ++k) {
    v.normalize();
    A.residual(zero.data(), v.data(), residuals.data());
    for (int i = 0; i < A.rows(); ++i) {
      const float *r = &residuals[3 * i], *D = &lattice_[l].D[9 * static_cast<std::size_t>(i)];
      for (int a = 0; a < 3; ++a) y[3 * i + a] = -(D[3 * a] * r[0] + D[3 * a + 1] * r[1] + D[3 * a + 2] * r[2]);
    }
    bound = 1.1 * y.norm();
    v = y;
  }
  return bound;
}

void CutMixedMultigrid::divergence(std::size_t l, const Eigen::VectorXf& u, Eigen::VectorXf& out) const {
  const CutLevel& lattice = lattice_[l];
  const float* b = levels_[l].gradient.data();
  Eigen::VectorXf copy;
  if (!lattice.carried.empty()) {
    copy = u;
    carry(lattice.carried, copy);
  }
  const float* at = lattice.carried.empty() ? u.data() : copy.data();
  for (std::size_t c = 0; c < lattice.corners.size(); ++c, b += 24) {
    float sum = 0;
    for (int n = 0; n < 8; ++n) {
      const float* v = at + 3 * lattice.corners[c][n];
      sum += b[3 * n] * v[0] + b[3 * n + 1] * v[1] + b[3 * n + 2] * v[2];
    }
    out[static_cast<Eigen::Index>(c)] = sum;
  }
}

void CutMixedMultigrid::add_gradient(std::size_t l, const Eigen::VectorXf& p, Eigen::VectorXf& out) const {
  const CutLevel& lattice = lattice_[l];
  const float* b = levels_[l].gradient.data();
  for (std::size_t c = 0; c < lattice.corners.size(); ++c, b += 24) {
    const float value = p[static_cast<Eigen::Index>(c)];
    for (int n = 0; n < 8; ++n) {
      float* v = out.data() + 3 * lattice.corners[c][n];
      for (int a = 0; a < 3; ++a) v[a] += value * b[3 * n + a];
    }
  }
  hand_back(lattice.carried, out);
}

void CutMixedMultigrid::scale_by_diagonal(std::size_t l, Eigen::VectorXf& v) const {
  const float* D = levels_[l].D.data();
  for (Eigen::Index i = 0; i < v.size(); i += 3, D += 9) {
    const float x = v[i], y = v[i + 1], z = v[i + 2];
    for (int a = 0; a < 3; ++a) v[i + a] = D[3 * a] * x + D[3 * a + 1] * y + D[3 * a + 2] * z;
  }
}

/// Sz = C z + B D B^T z.
void CutMixedMultigrid::schur(std::size_t l, const Eigen::VectorXf& z, Eigen::VectorXf& Sz) {
  Eigen::VectorXf t = Eigen::VectorXf::Zero(levels_[l].u.size());
  add_gradient(l, z, t);
  scale_by_diagonal(l, t);
  divergence(l, t, Sz);
  Sz += levels_[l].compliance.cwiseProduct(z);
}

void CutMixedMultigrid::bound_schur(std::size_t l) {
  Level& level = levels_[l];
  for (Eigen::Index i = 0; i < level.z.size(); ++i)
    level.z[i] = static_cast<float>(1 + 0.5 * ((i * 7919) % 13 - 6) / 6.0);
  for (int k = 0; k < 20; ++k) {
    level.z.normalize();
    schur(l, level.z, level.Bu);
    level.z = level.inverse_schur.cwiseProduct(level.Bu);
    level.schur_bound = 1.15 * level.z.norm();
  }
}

/// d = f - K u - B^T p, Bu = B u.
void CutMixedMultigrid::residual(std::size_t l) {
  Level& level = levels_[l];
  Eigen::VectorXf load = level.f;
  const Eigen::VectorXf minus_p = -level.p;
  add_gradient(l, minus_p, load);
  if (l == 0)
    for (Eigen::Index i = 0; i < load.size(); ++i)
      if (nodes_.fixed[i]) load[i] = 0;
  lattice_[l].A.residual(load.data(), level.u.data(), level.d.data());
  divergence(l, level.u, level.Bu);
}

void CutMixedMultigrid::sweep(std::size_t l) {
  Level& level = levels_[l];
  residual(l);
  scale_by_diagonal(l, level.d);
  divergence(l, level.d, level.r);
  level.r += level.Bu - level.g - level.compliance.cwiseProduct(level.p);
  const ChebyshevStep start(1, level.schur_bound);  // S q = r, nearly
  level.z = static_cast<float>(start.step) * level.inverse_schur.cwiseProduct(level.r);
  level.q = level.z;
  for (int k = 2; k <= chebyshev_steps_; ++k) {
    const ChebyshevStep step(k, level.schur_bound);
    schur(l, level.z, level.Bu);
    level.r -= level.Bu;
    level.z = static_cast<float>(step.previous) * level.z +
              static_cast<float>(step.step) * level.inverse_schur.cwiseProduct(level.r);
    level.q += level.z;
  }
  Eigen::VectorXf t = Eigen::VectorXf::Zero(level.u.size());
  add_gradient(l, level.q, t);
  scale_by_diagonal(l, t);
  level.u += level.d - t;
  level.p += level.q;
}

/// Eliminates p: (K_s + B^T C^-1 B) u = f + B^T C^-1 g, p = C^-1 (B u - g).
void CutMixedMultigrid::solve_coarsest() {
  const std::size_t l = levels_.size() - 1;
  Level& level = levels_[l];
  level.p = level.g.cwiseQuotient(level.compliance);
  Eigen::VectorXf b = level.f;
  add_gradient(l, level.p, b);
  level.u = coarsest_.solve(b);
  divergence(l, level.u, level.Bu);
  level.p = (level.Bu - level.g).cwiseQuotient(level.compliance);
}

void CutMixedMultigrid::cycle(std::size_t l) {
  if (l + 1 == levels_.size()) return solve_coarsest();
  Level &level = levels_[l], &below = levels_[l + 1];
  const CutLevel& lattice = lattice_[l];
  level.u.setZero();
  level.p.setZero();
  for (int s = 0; s < sweeps_of_cut_cells; ++s) sweep(l);
  residual(l);
  below.f.setZero();
  lattice.restrict_to(level.d, lattice_[l + 1], below.f);
  below.g.setZero();
  const Eigen::VectorXf volumes = level.g - level.Bu + level.compliance.cwiseProduct(level.p);
  for (Eigen::Index c = 0; c < volumes.size(); ++c) below.g[lattice.parent[c]] += volumes[c];
  cycle(l + 1);
  lattice.prolongate(below.u, lattice_[l + 1], level.u);
  if (l == 0)
    for (Eigen::Index i = 0; i < level.u.size(); ++i)
      if (nodes_.fixed[i]) level.u[i] = 0;
  for (Eigen::Index c = 0; c < volumes.size(); ++c) level.p[c] += below.p[lattice.parent[c]];
  for (int s = 0; s < sweeps_of_cut_cells; ++s) sweep(l);
}

Eigen::VectorXd CutMixedMultigrid::force(const Eigen::VectorXd& u, const Eigen::VectorXd& p) const {
  Eigen::VectorXd y;
  scaled_nodes_.multiply(K_, 1, u, y);
  for (Eigen::Index c = 0; c < p.size(); ++c)
    for (int n = 0; n < 8; ++n) y.segment<3>(3 * network_.cells[c][n]) += p[c] * gradient_.col(c).segment<3>(3 * n);
  hand_back(network_.carried, y);
  return y;
}

Eigen::VectorXd CutMixedMultigrid::volume_change(const Eigen::VectorXd& displacement) const {
  Eigen::VectorXd u = displacement;
  carry(network_.carried, u);
  Eigen::VectorXd J = Eigen::VectorXd::Zero(gradient_.cols());
  for (Eigen::Index c = 0; c < J.size(); ++c)
    for (int n = 0; n < 8; ++n) J[c] += gradient_.col(c).segment<3>(3 * n).dot(u.segment<3>(3 * network_.cells[c][n]));
  return J;
}

void CutMixedMultigrid::apply(const Eigen::VectorXd& f, const Eigen::VectorXd& g, Eigen::VectorXd& u,
                              Eigen::VectorXd& p) {
  levels_[0].f = scaled_nodes_.eliminated(f).cast<float>();
  levels_[0].g = g.cast<float>();
  cycle(0);
  scaled_nodes_.complete(f, levels_[0].u.cast<double>(), u);
  p = levels_[0].p.cast<double>();
}

KrylovResult CutMixedMultigrid::solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, double tolerance,
                                      int max_iterations, Eigen::VectorXd& u, Eigen::VectorXd& p) {
  const Eigen::Index n = f.size(), m = g.size();
  Eigen::VectorXd b(n + m), x = Eigen::VectorXd::Zero(n + m);
  b << f, g;
  const auto clear_fixed = [&](Eigen::VectorXd& v) {
    for (Eigen::Index i = 0; i < n; ++i)
      if (nodes_.fixed[i]) v[i] = 0;
  };
  clear_fixed(b);
  const Operator A = [&](const Eigen::VectorXd& v, Eigen::VectorXd& y) {
    y.resize(n + m);
    const Eigen::VectorXd of_u = v.head(n), of_p = v.tail(m);
    y << force(of_u, of_p), volume_change(of_u) - compliance_.cwiseProduct(of_p);
    clear_fixed(y);
  };
  const Operator precondition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    Eigen::VectorXd of_u, of_p;
    apply(r.head(n), r.tail(m), of_u, of_p);
    z.resize(n + m);
    z << of_u, of_p;
  };
  const KrylovResult result = gmres(A, precondition, b, tolerance, max_iterations, 60, x);
  u = x.head(n);
  p = x.tail(m);
  return result;
}

}  // namespace springproof
