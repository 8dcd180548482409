#include "msm/multigrid/mixed_multigrid.h"

#include <stdexcept>

namespace springproof {
namespace {

constexpr int sweeps = 2;      // before and after the coarser lattice
constexpr double omega = 1.3;  // damping of the displacement block in a Braess-Sarazin sweep

double corner_gradient(const CellStiffness& cell) { return cell.volume_gradient.cwiseAbs().maxCoeff(); }

}  // namespace

MixedMultigrid::MixedMultigrid(LatticeLevels levels, const CellStiffness& of_network, bool may_float)
    : lattice_(std::move(levels)),
      inner_steps_(of_network.kappa > 1000 ? 12 : 6),
      K_(lattice_.levels[0], reorder(of_network.without_volume, lattice_.axes), corner_gradient(of_network)) {
  if (!(of_network.kappa > 0)) throw std::invalid_argument("the mixed form needs kappa > 0 (nu > 1/4)");
  CellStiffness cell = of_network;
  cell.total = reorder(of_network.total, lattice_.axes);
  cell.without_volume = reorder(of_network.without_volume, lattice_.axes);
  for (const LatticeLevel& level : lattice_.levels) levels_.push_back(make_level(level, cell));
  for (Level& level : levels_) bound_schur(level);
  for (std::size_t l = 0; l + 1 < levels_.size(); ++l) {
    auto thin = std::make_unique<ThinParts>(lattice_.levels[l], cell.without_volume);
    if (!thin->empty()) levels_[l].thin = std::move(thin);
  }
  compliance_ = levels_[0].compliance.cast<double>();
  const LatticeLevel& finest = lattice_.levels[0];
  for (long c = 0; c < finest.cells(); ++c)
    compliance_[c] = cell.volume / cell.kappa * (finest.fill.empty() ? 1 : finest.fill[c]);
  factor_coarsest(assemble(lattice_.levels.back(), cell.total), lattice_, may_float, coarsest_);
}

MixedMultigrid::Level MixedMultigrid::make_level(const LatticeLevel& lattice, const CellStiffness& cell) const {
  const double h = lattice.edge_ratio, gradient = corner_gradient(cell);
  Level level{LatticeOperator<float>(lattice, cell.without_volume, gradient),
              {},
              {},
              {},
              1,
              {},
              {},
              {},
              {},
              {},
              {},
              {},
              {},
              {},
              nullptr};
  const long stride = lattice.stride(), cells = lattice.cells() + array_slack;
  const Eigen::VectorXd d = diagonal(lattice, cell.without_volume);
  level.inverse_diagonal = (d.array() > 0).select(1 / (omega * d.array()), 0).cast<float>().matrix();
  lattice.clear_fixed(level.inverse_diagonal);
  level.compliance = level.inverse_schur_diagonal = Eigen::VectorXf::Zero(cells);
  for (const CellRow& row : lattice.rows)
    for (int i = 0; i < row.length; ++i) {
      const double fill = lattice.fill.empty() ? 1 : lattice.fill[row.cell + i], b = fill * h * h * gradient;
      const double compliance = fill * h * h * h * cell.volume / cell.kappa;
      double sum = 0;
      for (int n = 0; n < 8; ++n)
        for (int a = 0; a < 3; ++a) sum += level.inverse_diagonal[a * stride + LatticeLevel::corner(row, i, n)];
      level.compliance[row.cell + i] = static_cast<float>(compliance);
      level.inverse_schur_diagonal[row.cell + i] = static_cast<float>(1 / (compliance + b * b * sum));
    }
  level.f = level.u = level.d = Eigen::VectorXf::Zero(3 * stride);
  level.g = level.p = level.Bu = level.r = level.z = level.q = Eigen::VectorXf::Zero(cells);
  return level;
}

/// Power iteration, with a margin since it approaches from below.
void MixedMultigrid::bound_schur(Level& level) const {
  const long cells = level.K.level().cells();
  for (long i = 0; i < cells; ++i) level.z[i] = static_cast<float>(1 + 0.5 * ((i * 7919) % 13 - 6) / 6.0);
  double bound = 1;
  for (int k = 0; k < 20; ++k) {
    level.z.normalize();
    level.r.setZero();
    schur_step(level, ChebyshevStep(0.0, -1.0));
    bound = level.z.norm();
  }
  level.schur_bound = 1.15 * bound;
  level.q.setZero();
}

void MixedMultigrid::schur_step(Level& level, const ChebyshevStep& step) const {
  LatticeOperator<float>& K = level.K;
  const LatticeLevel& lattice = K.level();
  const long stride = K.stride();
  K.gradient_pass(level.z.data(), [&](int k, long begin, long n) {
    for (int a = 0; a < 3; ++a)
      Eigen::Map<Eigen::ArrayXf>(K.plane(k, a), n) *= level.inverse_diagonal.segment(a * stride + begin, n).array();
    if (k == 0) return;
    const long first = lattice.cell_begin[k - 1], cells = lattice.cell_begin[k] - first;
    K.divergence_of_planes(k - 1, level.Bu.data());
    K.kernels().schur_step(cells, level.Bu.data() + first, level.compliance.data() + first,
                           level.inverse_schur_diagonal.data() + first, static_cast<float>(step.previous),
                           static_cast<float>(step.step), level.r.data() + first, level.z.data() + first,
                           level.q.data() + first);
  });
}

/// q of S q = r, nearly; r is used up.
void MixedMultigrid::solve_schur(Level& level) const {
  const ChebyshevStep start(1, level.schur_bound);
  level.z = static_cast<float>(start.step) * level.inverse_schur_diagonal.cwiseProduct(level.r);
  level.q = level.z;
  for (int k = 2; k <= inner_steps_; ++k) schur_step(level, ChebyshevStep(k, level.schur_bound));
}

void MixedMultigrid::sweep(Level& level, bool from_zero) const {
  LatticeOperator<float>& K = level.K;
  const long stride = K.stride();
  if (from_zero) {
    level.d = level.inverse_diagonal.cwiseProduct(level.f);
    K.divergence(level.d.data(), level.r.data());
    level.r -= level.g;
  } else {
    K.pass(level.u.data(), level.p.data(), level.Bu.data(), [&](int a, long begin, long n, const float* y) {
      const long at = a * stride + begin;
      level.d.segment(at, n) = level.inverse_diagonal.segment(at, n).cwiseProduct(
          level.f.segment(at, n) - Eigen::Map<const Eigen::VectorXf>(y, n));
    });
    K.divergence(level.d.data(), level.r.data());
    level.r += level.Bu - level.g - level.compliance.cwiseProduct(level.p);
  }
  solve_schur(level);
  K.gradient_pass(level.q.data(), [&](int k, long begin, long n) {
    for (int a = 0; a < 3; ++a) {
      const long at = a * stride + begin;
      level.u.segment(at, n) += level.d.segment(at, n) - level.inverse_diagonal.segment(at, n).cwiseProduct(
                                                             Eigen::Map<const Eigen::VectorXf>(K.plane(k, a), n));
    }
  });
  level.p += level.q;
}

/// Eliminates p: (K_s + B^T C^-1 B) u = f + B^T C^-1 g, p = C^-1 (B u - g).
void MixedMultigrid::solve_coarsest(Level& level) const {
  LatticeOperator<float>& K = level.K;
  const long cells = K.level().cells(), points = K.level().points(), stride = K.stride();
  level.z.head(cells) = level.g.head(cells).cwiseQuotient(level.compliance.head(cells));
  Eigen::VectorXd b(3 * points), x;
  K.gradient_pass(level.z.data(), [&](int k, long begin, long n) {
    for (int a = 0; a < 3; ++a)
      for (long i = 0; i < n; ++i) b[3 * (begin + i) + a] = level.f[a * stride + begin + i] + K.plane(k, a)[i];
  });
  coarsest_.solve(b, x);
  for (long n = 0; n < points; ++n)
    for (int a = 0; a < 3; ++a) level.u[a * stride + n] = static_cast<float>(x[3 * n + a]);
  K.divergence(level.u.data(), level.Bu.data());
  level.p.head(cells) = (level.Bu.head(cells) - level.g.head(cells)).cwiseQuotient(level.compliance.head(cells));
}

void MixedMultigrid::residual(Level& level) const {
  const long stride = level.K.stride();
  level.K.pass(level.u.data(), level.p.data(), level.Bu.data(), [&](int a, long begin, long n, const float* y) {
    const long at = a * stride + begin;
    level.d.segment(at, n) = level.f.segment(at, n) - Eigen::Map<const Eigen::VectorXf>(y, n);
  });
  level.K.level().clear_fixed(level.d);
}

/// Bending moves a thin part's middle without change of volume; what the sections must do with it is left to the
/// sweeps.
void MixedMultigrid::correct_thin_parts(Level& level) const {
  Eigen::VectorXf motion = Eigen::VectorXf::Zero(level.u.size());
  level.thin->correct(level.d.data(), motion.data());
  level.u += motion;
}

/// (u, p) of a level from its (f, g).
void MixedMultigrid::cycle(std::size_t l) {
  Level& level = levels_[l];
  if (l + 1 == levels_.size()) {
    solve_coarsest(level);
    return;
  }
  level.u.setZero();
  level.p.setZero();
  for (int s = 0; s < sweeps; ++s) sweep(level, s == 0);
  LatticeOperator<float>& K = level.K;
  const long stride = K.stride();
  residual(level);
  if (level.thin) {
    correct_thin_parts(level);
    residual(level);
  }
  level.r = level.g - level.Bu + level.compliance.cwiseProduct(level.p);
  Level& below = levels_[l + 1];
  const LatticeLevel& lattice = below.K.level();
  below.f.setZero();
  restrict_field(lattice, K.kernels(), stride, level.d.data(), below.f.data());
  below.g.setZero();
  const long cells = K.level().cells();
  for (long c = 0; c < cells; ++c) below.g[lattice.parent[c]] += level.r[c];
  cycle(l + 1);
  prolongate_field(lattice, K.kernels(), below.u.data(), stride, level.d.data());
  K.level().clear_fixed(level.d);
  level.u += level.d;
  for (long c = 0; c < cells; ++c) level.p[c] += below.p[lattice.parent[c]];
  if (level.thin) {
    residual(level);
    correct_thin_parts(level);
  }
  for (int s = 0; s < sweeps; ++s) sweep(level, false);
}

void MixedMultigrid::multiply_rows(const double* x, double* y) {
  const long stride = K_.stride(), cells = lattice_.levels[0].cells();
  const double* p = x + pressures();
  double* Bu = y + pressures();
  K_.pass(x, p, Bu, [&](int a, long begin, long n, const double* values) {
    std::memcpy(y + a * stride + begin, values, n * sizeof(double));
  });
  for (long c = 0; c < cells; ++c) Bu[c] -= compliance_[c] * p[c];
  for (int a = 0; a < 3; ++a) std::fill_n(y + (a + 1) * stride - array_slack, array_slack, 0.0);
  std::fill_n(Bu + cells, array_slack, 0.0);
}

void MixedMultigrid::cells_to_rows(const Eigen::VectorXd& cells, double* rows) const {
  for (std::size_t c = 0; c < lattice_.cell_of_cell.size(); ++c)
    rows[lattice_.cell_of_cell[c]] = cells[static_cast<Eigen::Index>(c)];
}

Eigen::VectorXd MixedMultigrid::cells_from_rows(const double* rows) const {
  Eigen::VectorXd cells(static_cast<Eigen::Index>(lattice_.cell_of_cell.size()));
  for (std::size_t c = 0; c < lattice_.cell_of_cell.size(); ++c)
    cells[static_cast<Eigen::Index>(c)] = rows[lattice_.cell_of_cell[c]];
  return cells;
}

KrylovResult MixedMultigrid::solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, double tolerance,
                                   int max_iterations, Eigen::VectorXd& u, Eigen::VectorXd& p) {
  const LatticeLevel& finest = lattice_.levels[0];
  const Eigen::Index n = pressures(), m = size() - n;
  Eigen::VectorXd f_rows, b = Eigen::VectorXd::Zero(size()), x = Eigen::VectorXd::Zero(size());
  lattice_.to_rows(f, f_rows);
  finest.clear_fixed(f_rows);
  b.head(n) = f_rows;
  cells_to_rows(g, b.data() + n);
  const Operator A = [&](const Eigen::VectorXd& v, Eigen::VectorXd& y) {
    y.resize(v.size());
    multiply_rows(v.data(), y.data());
    finest.clear_fixed(y);
  };
  const Operator condition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    Level& top = levels_[0];
    top.f = r.head(n).cast<float>();
    top.g = r.tail(m).cast<float>();
    cycle(0);
    z.resize(r.size());
    z.head(n) = top.u.cast<double>();
    z.tail(m) = top.p.cast<double>();
  };
  const KrylovResult result = gmres(A, condition, b, tolerance, max_iterations, 60, x);
  lattice_.from_rows(x.head(n), u);
  p = cells_from_rows(x.data() + n);
  return result;
}

void MixedMultigrid::apply(const Eigen::VectorXd& f, const Eigen::VectorXd& g, Eigen::VectorXd& u, Eigen::VectorXd& p) {
  Level& finest = levels_[0];
  Eigen::VectorXd f_rows, g_rows = Eigen::VectorXd::Zero(size() - pressures());
  lattice_.to_rows(f, f_rows);
  cells_to_rows(g, g_rows.data());
  finest.f = f_rows.cast<float>();
  finest.g = g_rows.cast<float>();
  cycle(0);
  f_rows = finest.u.cast<double>();
  g_rows = finest.p.cast<double>();
  lattice_.from_rows(f_rows, u);
  p = cells_from_rows(g_rows.data());
}

Eigen::VectorXd MixedMultigrid::force(const Eigen::VectorXd& u, const Eigen::VectorXd& p) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size()), y(size()), u_rows, f;
  lattice_.to_rows(u, u_rows);
  x.head(pressures()) = u_rows;
  cells_to_rows(p, x.data() + pressures());
  multiply_rows(x.data(), y.data());
  lattice_.from_rows(y, f);
  return f;
}

Eigen::VectorXd MixedMultigrid::volume_change(const Eigen::VectorXd& u) {
  Eigen::VectorXd u_rows, Bu(lattice_.levels[0].cells() + array_slack);
  lattice_.to_rows(u, u_rows);
  K_.divergence(u_rows.data(), Bu.data());
  return cells_from_rows(Bu.data());
}

}  // namespace springproof
