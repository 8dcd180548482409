#include "msm/multigrid/cut_mixed_multigrid.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "msm/multigrid/multigrid.h"

namespace springproof {
namespace {

constexpr int sweeps_of_cut_cells = 2;  // before and after the coarser lattice
constexpr float damped = 2;             // of the inverse diagonal blocks in the Schur complement; 1 diverges

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
  schur_sweeps_ = kappa > 1000 ? 12 : 6;
  gradient_.resize(24, static_cast<Eigen::Index>(network.cells.size()));
  compliance_.resize(gradient_.cols());
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const double h = network.edge(c) / l;
    gradient_.col(static_cast<Eigen::Index>(c)) = volume_gradient(h, network.filled[c]);
    compliance_[static_cast<Eigen::Index>(c)] = network.filled[c].fraction * h * h * h / kappa;
  }
  levels_.resize(lattice_.size());
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
  CutLevel& lattice = lattice_[l];
  Level& level = levels_[l];
  lattice.invert_anchored();
  const std::size_t cells = lattice.cubes.size();
  level.f = level.u = level.d = Eigen::VectorXf::Zero(lattice.unknowns());
  level.compliance = level.inverse_schur = level.g = level.p = level.Bu = level.r = level.q =
      Eigen::VectorXf::Zero(static_cast<Eigen::Index>(cells));
  level.gradient.resize(24 * cells);
  for (std::size_t c = 0; c < cells; ++c) {
    const double h = lattice.cell_edge(c) / lattice_[0].edge;
    const Eigen::Matrix<double, 24, 1> b = volume_gradient(h, lattice.filled[c]);
    for (int i = 0; i < 24; ++i) level.gradient[24 * c + i] = static_cast<float>(b[i]);
    level.compliance[static_cast<Eigen::Index>(c)] = static_cast<float>(lattice.filled[c].fraction * h * h * h / kappa);
  }
  set_up_schur(l);
}

void CutMixedMultigrid::set_up_schur(std::size_t l) {
  const CutLevel& lattice = lattice_[l];
  Level& level = levels_[l];
  struct Entry {
    int cell;
    Eigen::Vector3f b, Db;
  };
  std::vector<std::vector<Entry>> at(lattice.point.size());  // columns of B, with what carried corners hand back
  const Carriers carriers = carriers_of(static_cast<int>(lattice.point.size()), lattice.carried);
  const int cells = static_cast<int>(lattice.corners.size());
  const auto hand = [&](int p, int c, const Eigen::Vector3f& b) {
    const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> D(&lattice.D[9 * static_cast<std::size_t>(p)]);
    at[p].push_back({c, b, damped * (D * b)});
  };
  for (int c = 0; c < cells; ++c)
    for (int n = 0; n < 8; ++n) {
      const Eigen::Vector3f b =
          Eigen::Map<const Eigen::Vector3f>(&level.gradient[24 * static_cast<std::size_t>(c) + 3 * n]);
      for_each_carrier(carriers, lattice.corners[c][n],
                       [&](int p, double w) { hand(p, c, static_cast<float>(w) * b); });
    }
  level.begin = {0};
  std::vector<int> place(cells, -1);  // of each column in the row
  std::set<int> points;
  for (int c = 0; c < cells; ++c) {
    const int start = level.begin.back();
    const auto add = [&](int column, float value) {
      if (place[column] < start) {
        place[column] = static_cast<int>(level.column.size());
        level.column.push_back(column);
        level.schur.push_back(0);
      }
      level.schur[place[column]] += value;
    };
    add(c, level.compliance[c]);
    points.clear();
    for (const int q : lattice.corners[c]) for_each_carrier(carriers, q, [&](int p, double) { points.insert(p); });
    for (const int p : points)
      for (const Entry& own : at[p])
        if (own.cell == c)
          for (const Entry& other : at[p]) add(other.cell, own.b.dot(other.Db));
    level.inverse_schur[c] = 1 / level.schur[start];
    level.begin.push_back(static_cast<int>(level.column.size()));
  }
}

void CutMixedMultigrid::relax_schur(bool ascending, Level& level) {
  const int rows = static_cast<int>(level.r.size());
  for (int n = 0; n < rows; ++n) {
    const int i = ascending ? n : rows - 1 - n;
    float even = 0, odd = 0;  // two sums, since each addition waits for the one before
    int e = level.begin[i];
    for (; e + 1 < level.begin[i + 1]; e += 2) {
      even += level.schur[e] * level.q[level.column[e]];
      odd += level.schur[e + 1] * level.q[level.column[e + 1]];
    }
    if (e < level.begin[i + 1]) even += level.schur[e] * level.q[level.column[e]];
    const float sum = level.r[i] - even - odd;
    level.q[i] += level.inverse_schur[i] * sum;
  }
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
  const float* D = lattice_[l].D.data();
  for (Eigen::Index i = 0; i < v.size(); i += 3, D += 9) {
    const float x = v[i], y = v[i + 1], z = v[i + 2];
    for (int a = 0; a < 3; ++a) v[i + a] = damped * (D[3 * a] * x + D[3 * a + 1] * y + D[3 * a + 2] * z);
  }
}

Eigen::VectorXf CutMixedMultigrid::load(std::size_t l) const {
  const Level& level = levels_[l];
  Eigen::VectorXf all = level.f;
  const Eigen::VectorXf minus_p = -level.p;
  add_gradient(l, minus_p, all);
  if (l == 0)
    for (Eigen::Index i = 0; i < all.size(); ++i)
      if (nodes_.fixed[i]) all[i] = 0;
  return all;
}

/// d = f - K u - B^T p, Bu = B u.
void CutMixedMultigrid::residual(std::size_t l) {
  Level& level = levels_[l];
  lattice_[l].A.residual(load(l).data(), level.u.data(), level.d.data());
  divergence(l, level.u, level.Bu);
}

/// Gauss-Seidel for the displacements, then pressures q and displacements -D B^T q that restore the volumes.
void CutMixedMultigrid::sweep(std::size_t l, bool ascending) {
  Level& level = levels_[l];
  const CutLevel& lattice = lattice_[l];
  const Eigen::VectorXf b = load(l);
  const auto relax_anchored = [&] {
    const std::size_t count = lattice.anchored.size();
    for (std::size_t c = 0; c < count; ++c)
      lattice.relax_anchored(ascending ? c : count - 1 - c, b.data(), level.u.data());
  };
  if (!ascending) relax_anchored();
  lattice.A.relax(lattice.D, ascending, b.data(), level.u.data());
  if (ascending) relax_anchored();
  divergence(l, level.u, level.Bu);
  level.r = level.Bu - level.g - level.compliance.cwiseProduct(level.p);
  level.q.setZero();
  for (int s = 0; s < schur_sweeps_; ++s) relax_schur((s % 2 == 0) == ascending, level);
  Eigen::VectorXf t = Eigen::VectorXf::Zero(level.u.size());
  add_gradient(l, level.q, t);
  scale_by_diagonal(l, t);
  level.u -= t;
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
  for (int s = 0; s < sweeps_of_cut_cells; ++s) sweep(l, true);
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
  for (int s = 0; s < sweeps_of_cut_cells; ++s) sweep(l, false);
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
