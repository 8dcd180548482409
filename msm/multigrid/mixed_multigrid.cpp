#include "msm/multigrid/mixed_multigrid.h"

#include <cstring>
#include <stdexcept>

namespace springproof {
namespace {

/// |dV/du| of a corner by displacements of the levels, the same along each axis.
double corner_gradient(const CellStiffness& of_network, const LatticeLevels& lattice) {
  return of_network.volume_gradient.cwiseProduct(lattice.proportions.replicate<8, 1>()).cwiseAbs().maxCoeff();
}

/// B and K_s run over the cells in the same pass.
class CellPressures : public SaddlePointLevel {
 public:
  /// `cell`: total and without_volume of the levels; `gradient`: corner_gradient().
  CellPressures(const LatticeLevel& lattice, const CellStiffness& cell, double gradient, bool coarsest)
      : SaddlePointLevel(lattice, cell.without_volume, gradient, lattice.cells() + array_slack, cell.kappa) {
    const double h = lattice.edge_ratio;
    for (const CellRow& row : lattice.rows)
      for (int i = 0; i < row.length; ++i) {
        const double fill = lattice.fill.empty() ? 1 : lattice.fill[row.cell + i], b = fill * h * h * gradient;
        const double C = fill * h * h * h * cell.volume / cell.kappa;
        double sum = 0;
        for (int n = 0; n < 8; ++n)
          for (int a = 0; a < 3; ++a) sum += inverse_diagonal_[a * lattice.stride() + LatticeLevel::corner(row, i, n)];
        compliance[row.cell + i] = static_cast<float>(C);
        inverse_schur_diagonal_[row.cell + i] = static_cast<float>(1 / (C + b * b * sum));
      }
    bound_schur();
    if (!coarsest) thin_ = ThinParts::of(lattice, cell.without_volume);
  }

 private:
  void restrict_pressures(SaddlePointLevel& below) override {
    const Eigen::VectorXf volumes = g - Bu + compliance.cwiseProduct(p);
    for (long c = 0; c < K.level().cells(); ++c) below.g[below.K.level().parent[c]] += volumes[c];
  }

  void prolongate_pressures(const SaddlePointLevel& below) override {
    for (long c = 0; c < K.level().cells(); ++c) p[c] += below.p[below.K.level().parent[c]];
  }

  void take_residual() override {
    K.pass(u.data(), p.data(), Bu.data(), [&](int a, long begin, long n, const float* y) {
      const long at = a * K.stride() + begin;
      d.segment(at, n) = f.segment(at, n) - Eigen::Map<const Eigen::VectorXf>(y, n);
    });
  }

  void predict(bool from_zero) override {
    if (from_zero) {
      d = inverse_diagonal_.cwiseProduct(f);
      K.divergence(d.data(), r_.data());
      r_ -= g;
      return;
    }
    K.pass(u.data(), p.data(), Bu.data(), [&](int a, long begin, long n, const float* y) {
      const long at = a * K.stride() + begin;
      d.segment(at, n) =
          inverse_diagonal_.segment(at, n).cwiseProduct(f.segment(at, n) - Eigen::Map<const Eigen::VectorXf>(y, n));
    });
    K.divergence(d.data(), r_.data());
    r_ += Bu - g - compliance.cwiseProduct(p);
  }

  void schur_step(const ChebyshevStep& step) override {
    const LatticeLevel& lattice = K.level();
    K.gradient_pass(z_.data(), [&](int k, long begin, long n) {
      for (int a = 0; a < 3; ++a)
        Eigen::Map<Eigen::ArrayXf>(K.plane(k, a), n) *= inverse_diagonal_.segment(a * K.stride() + begin, n).array();
      if (k == 0) return;
      const long first = lattice.cell_begin[k - 1], cells = lattice.cell_begin[k] - first;
      K.divergence_of_planes(k - 1, Bu.data());
      K.kernels().schur_step(cells, Bu.data() + first, compliance.data() + first,
                             inverse_schur_diagonal_.data() + first, static_cast<float>(step.previous),
                             static_cast<float>(step.step), r_.data() + first, z_.data() + first, q_.data() + first);
    });
  }

  void correct_displacements() override {
    K.gradient_pass(q_.data(), [&](int k, long begin, long n) {
      for (int a = 0; a < 3; ++a) {
        const long at = a * K.stride() + begin;
        u.segment(at, n) += d.segment(at, n) - inverse_diagonal_.segment(at, n).cwiseProduct(
                                                   Eigen::Map<const Eigen::VectorXf>(K.plane(k, a), n));
      }
    });
  }
};

}  // namespace

MixedMultigrid::MixedMultigrid(LatticeLevels levels, const CellStiffness& of_network, bool may_float)
    : lattice_(std::move(levels)),
      K_(lattice_.levels[0], cell_of_levels(of_network.without_volume, lattice_),
         corner_gradient(of_network, lattice_)) {
  if (!(of_network.kappa > 0)) throw std::invalid_argument("the mixed form needs kappa > 0 (nu > 1/4)");
  CellStiffness cell = of_network;
  cell.total = cell_of_levels(of_network.total, lattice_);
  cell.without_volume = cell_of_levels(of_network.without_volume, lattice_);
  for (const LatticeLevel& level : lattice_.levels)
    levels_.push_back(std::make_unique<CellPressures>(level, cell, corner_gradient(of_network, lattice_),
                                                      &level == &lattice_.levels.back()));
  const LatticeLevel& finest = lattice_.levels[0];
  Eigen::VectorXd compliance(finest.cells());
  for (long c = 0; c < finest.cells(); ++c)
    compliance[c] = cell.volume / cell.kappa * (finest.fill.empty() ? 1 : finest.fill[c]);
  take_compliance(compliance);
  change_.setZero(finest.cells() + array_slack);
  factor_coarsest(assemble(lattice_.levels.back(), cell.total), lattice_, may_float, coarsest_);
}

/// Eliminates p: (K_s + B^T C^-1 B) u = f + B^T C^-1 g, p = C^-1 (B u - g).
void MixedMultigrid::solve_coarsest(SaddlePointLevel& level) const {
  LatticeOperator<float>& K = level.K;
  const long cells = K.level().cells(), points = K.level().points(), stride = K.stride();
  level.p.head(cells) = level.g.head(cells).cwiseQuotient(level.compliance.head(cells));
  Eigen::VectorXd b(3 * points), x;
  K.gradient_pass(level.p.data(), [&](int k, long begin, long n) {
    for (int a = 0; a < 3; ++a)
      for (long i = 0; i < n; ++i) b[3 * (begin + i) + a] = level.f[a * stride + begin + i] + K.plane(k, a)[i];
  });
  coarsest_.solve(b, x);
  for (long n = 0; n < points; ++n)
    for (int a = 0; a < 3; ++a) level.u[a * stride + n] = static_cast<float>(x[3 * n + a]);
  K.divergence(level.u.data(), level.Bu.data());
  level.p.head(cells) = (level.Bu.head(cells) - level.g.head(cells)).cwiseQuotient(level.compliance.head(cells));
}

void MixedMultigrid::cycle_on_levels() {
  v_cycle(levels_, [&](SaddlePointLevel& level) { solve_coarsest(level); });
}

void MixedMultigrid::force_rows(const double* u, const double* p, double* y) {
  const long stride = K_.stride();
  K_.pass(u, p, change_.data(), [&](int a, long begin, long n, const double* values) {
    std::memcpy(y + a * stride + begin, values, n * sizeof(double));
  });
}

}  // namespace springproof
