// The elastic system on straight-sided quadratic tetrahedra and its multigrid.  Part of elastic_solver.cpp, like
// stiffness.h.
#pragma once

#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/precondition.h>

#include <memory>
#include <optional>

#include "fem_reference/solvers/block_triangular.h"
#include "fem_reference/solvers/coarsest_level.h"
#include "fem_reference/solvers/tetrahedra.h"

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

// Chebyshev smoothing on quadratic tetrahedra, in single precision, and linear elements below them.
class TetrahedraCycle {
 public:
  TetrahedraCycle(const ElasticSystem& system, double lambda) : level_(system, lambda), below_(system.below) {
    typename Smoother::AdditionalData data;
    data.degree = 4;
    data.smoothing_range = 10;
    data.eig_cg_n_iterations = 30;  // slivers cause a few eigenvalues far above the rest
    data.preconditioner = std::make_shared<dealii::DiagonalMatrix<Vector<float>>>(level_.inverse_diagonal());
    smoother_.initialize(level_, data);
    x_ = b_ = t_ = coarse_ = level_.vector();
  }

  void vmult(Vector<double>& y, const Vector<double>& x) const {
    b_ = x;
    level_.clear_constrained(b_);
    smoother_.vmult(x_, b_);
    level_.vmult(t_, x_);
    t_.sadd(-1, 1, b_);
    below_(coarse_, t_);
    x_ += coarse_;
    smoother_.step(x_, b_);
    y = x_;
  }

 private:
  using Level = TetrahedraStiffness<float>;
  using Smoother = dealii::PreconditionChebyshev<Level, Vector<float>>;

  Level level_;
  Smoother smoother_;
  std::function<void(LevelVector&, const LevelVector&)> below_;
  mutable Vector<float> x_, b_, t_, coarse_;
};

// [ 2 mu eps : eps   p div v       ]
// [ q div u          -p q / lambda ]
// with continuous linear pressures (Taylor and Hood 1973), or in the displacement form its stiffness alone.
class TetrahedraOperator {
 public:
  explicit TetrahedraOperator(const ElasticSystem& system)
      : system_(system),
        mixed_(system.form == Form::mixed),
        mu_(system.mu),
        lambda_(system.lambda),
        pressure_(system.body.triangulation),
        stiffness_(system, mixed_ ? 0 : lambda_),
        multigrid_(system, mixed_ ? 0 : lambda_) {
    if (!mixed_) return;
    pressure_.distribute_dofs(dealii::FE_SimplexP<3>(1));
    cells_.emplace(system.dof_handler, &pressure_);
    inverse_mass_ = Vector<double>(pressure_.n_dofs());
    for (const auto& batch : cells_->batches()) {
      const Lane m = 0.4 * batch.weight;
      Cells::add_corners(batch, {m, m, m, m}, inverse_mass_);
    }
    for (double& m : inverse_mass_) m = 1 / m;
  }

  MixedField vector() const { return {stiffness_.vector(), Vector<double>(mixed_ ? pressure_.n_dofs() : 0)}; }

  void apply(MixedField& y, const MixedField& x) const {
    if (!mixed_) return stiffness_.apply(y.u, x.u);
    y.u = 0;
    y.p = 0;
    for (const auto& batch : cells_->batches()) {
      const Cells::Corners p = Cells::read_corners(batch, x.p);
      Cells::Corners r = {};
      const Lane mu = mu_ * batch.weight;
      const auto f = Cells::forces(batch, Cells::read(batch, x.u), [&](int q, auto& h) {
        const Lane pressure = Cells::at_point(p, q);
        const Lane excess = batch.weight * (trace(h) - 1 / lambda_ * pressure);
        for (int i = 0; i < 4; ++i) r[i] += (i == q ? Cells::inner : Cells::outer) * excess;
        h = mu * (h + transpose(h));
        for (int i = 0; i < 3; ++i) h[i][i] += batch.weight * pressure;
      });
      Cells::add(batch, f, y.u);
      Cells::add_corners(batch, r, y.p);
    }
  }

  void vmult(MixedField& y, const MixedField& x) const {
    stiffness_.without_constrained(x.u, [&] { apply(y, x); });
    stiffness_.clear_constrained(y.u);
  }

  void clear_constrained(Vector<double>& f) const { stiffness_.clear_constrained(f); }

  void couple(Vector<double>& f, const Vector<double>& p) const {
    f = 0;
    const Cells::Nodal at_rest = {};
    for (const auto& batch : cells_->batches()) {
      const Cells::Corners corners = Cells::read_corners(batch, p);
      Cells::add(batch,
                 Cells::forces(batch, at_rest,
                               [&](int q, auto& h) {
                                 for (int i = 0; i < 3; ++i) h[i][i] = batch.weight * Cells::at_point(corners, q);
                               }),
                 f);
    }
    clear_constrained(f);
  }

  void precondition_displacement(Vector<double>& z, const Vector<double>& r) const {
    factors_ ? factors_(z, r) : multigrid_.vmult(z, r);
    clear_constrained(z);
  }

  void precondition_pressure(Vector<double>& y, const Vector<double>& x) const {
    const auto multiply = [&](Vector<double>& to, const Vector<double>& from) {
      to = 0;
      for (const auto& batch : cells_->batches()) {
        Cells::Corners m = Cells::read_corners(batch, from);
        const Lane sum = m[0] + m[1] + m[2] + m[3];
        for (int i = 0; i < 4; ++i) m[i] = 0.2 * batch.weight * (sum + m[i]);
        Cells::add_corners(batch, m, to);
      }
    };
    divide_by_mass_matrix(multiply, inverse_mass_, x, y);
    y *= 1 / (1 / lambda_ + 0.5 / mu_);
  }

  bool factorise(const MixedField&) {
    if (factors_) return false;
    factors_ = factored_stiffness(system_);
    return static_cast<bool>(factors_);
  }

  CellPressures pressures(const MixedField& x) const {
    CellPressures all;
    for (const auto& cell : pressure_.active_cell_iterators()) {
      const auto p = dofs_in(cell, pressure_);
      const double first = x.p(p[0]);
      all.push_back({first, x.p(p[1]) - first, x.p(p[2]) - first, x.p(p[3]) - first});
    }
    return all;
  }

 private:
  using Cells = Tetrahedra<double>;
  using Lane = Cells::Lane;

  const ElasticSystem& system_;
  bool mixed_;
  double mu_, lambda_;
  dealii::DoFHandler<3> pressure_;
  TetrahedraStiffness<double> stiffness_;
  TetrahedraCycle multigrid_;
  std::optional<Cells> cells_;
  Vector<double> inverse_mass_;
  std::function<void(DofVector&, const DofVector&)> factors_;  // in place of the multigrid
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
