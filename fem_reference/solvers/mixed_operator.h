// Matrix-free operators of small strain, with pressures or without.  Part of elastic_solver.cpp, like stiffness.h.
#pragma once

#include "fem_reference/grid/processes.h"
#include "fem_reference/solvers/mixed_field.h"
#include "fem_reference/solvers/stiffness.h"
#include "fem_reference/solvers/v_cycle.h"
#include "fem_reference/system/elastic_system.h"

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

/// Discontinuous pressures, per cell: a constant (Q1), or a constant and the three coordinates of the reference cell
/// (Q2).
template <int degree>
struct PressureSpace {
  using Cell = typename Stiffness<degree, double>::Cell;
  using Cells = typename Stiffness<degree, double>::Cells;
  using Lane = Lanes<double>;
  static constexpr int functions = degree == 1 ? 1 : 4;
  using Coefficients = std::array<Lane, functions>;

  explicit PressureSpace(const Cells& cells) {
    const dealii::QGauss<3> quadrature(degree + 1);
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      for (int f = 0; f < functions; ++f) basis[f][q] = f == 0 ? 1 : 2 * quadrature.point(q)[f - 1] - 1;

    const unsigned int size = cells.n_cell_batches() * functions * Lane::size();
    if (process_count() == 1)
      inverse_mass.reinit(size);
    else  // contiguous index ranges, one per process
      inverse_mass.reinit(size, 0, cells.get_dof_handler().get_communicator());
    Cell u(cells);
    for (unsigned int batch = 0; batch < cells.n_cell_batches(); ++batch) {
      u.reinit(batch);
      Coefficients mass{};
      for (unsigned int q = 0; q < Cell::static_n_q_points; ++q)
        for (int f = 0; f < functions; ++f) mass[f] += basis[f][q] * basis[f][q] * u.JxW(q);
      for (int f = 0; f < functions; ++f)
        for (unsigned int lane = 0; lane < cells.n_active_entries_per_cell_batch(batch); ++lane)
          inverse_mass.local_element((batch * functions + f) * Lane::size() + lane) = 1 / mass[f][lane];
    }
  }

  Coefficients read(const Vector<double>& p, unsigned int batch) const {
    Coefficients c;
    for (int f = 0; f < functions; ++f) c[f].load(p.begin() + (batch * functions + f) * Lane::size());
    return c;
  }

  void write(const Coefficients& c, unsigned int batch, Vector<double>& p) const {
    for (int f = 0; f < functions; ++f) c[f].store(p.begin() + (batch * functions + f) * Lane::size());
  }

  Lane value(const Coefficients& c, unsigned int q) const {
    Lane p = c[0];
    for (int f = 1; f < functions; ++f) p += c[f] * basis[f][q];
    return p;
  }

  /// y = scale * M^-1 x with the diagonal of the mass matrix M.
  void divide_by_mass(double scale, const Vector<double>& x, Vector<double>& y) const {
    for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
      y.local_element(i) = scale * inverse_mass.local_element(i) * x.local_element(i);
  }

  /// The pressure of each cell as an affine function of the reference coordinates.
  CellPressures per_cell(const Cells& cells, const Vector<double>& p) const {
    CellPressures all(cells.n_cell_batches() == 0 ? 0 : cells.get_dof_handler().get_triangulation().n_active_cells());
    for (unsigned int batch = 0; batch < cells.n_cell_batches(); ++batch)
      for (unsigned int lane = 0; lane < cells.n_active_entries_per_cell_batch(batch); ++lane) {
        std::array<double, 4>& c = all[cells.get_cell_iterator(batch, lane)->active_cell_index()];
        const auto coefficient = [&](int f) { return p.local_element((batch * functions + f) * Lane::size() + lane); };
        c[0] = coefficient(0);
        for (int f = 1; f < functions; ++f) {
          c[0] -= coefficient(f);
          c[f] = 2 * coefficient(f);
        }
      }
    return all;
  }

  std::array<std::array<double, Cell::static_n_q_points>, functions> basis;
  Vector<double> inverse_mass;  ///< reciprocals of the diagonal; zero in lanes without a cell
};

constexpr unsigned int active_cells = dealii::numbers::invalid_unsigned_int;

// What operators of small and of finite strain share: displacements, pressures where the form has them, and the
// preconditioners of both.  `Own` has apply(y, x).
template <int degree, typename Own>
class OperatorWithPressures {
 public:
  using Base = Stiffness<degree, double>;
  using Cell = typename Base::Cell;
  using Lane = Lanes<double>;

  MixedField vector() const {
    MixedField x;
    x.u = base_.vector();
    if (mixed()) x.p.reinit(pressure_.inverse_mass);
    return x;
  }

  /// The same as apply(), with constrained rows and columns set to zero.
  void vmult(MixedField& y, const MixedField& x) const {
    base_.without_constrained(x.u, [&] { static_cast<const Own&>(*this).apply(y, x); });
    base_.clear_constrained(y.u);
  }

  void clear_constrained(Vector<double>& f) const { base_.clear_constrained(f); }
  CellPressures pressures(const MixedField& x) const { return pressure_.per_cell(base_.cells(), x.p); }
  void precondition_displacement(Vector<double>& z, const Vector<double>& r) const { multigrid_.vmult(z, r); }
  /// Multiplies by (M (1/lambda + 1/(2 mu)))^-1, an approximate inverse of the Schur complement.
  void precondition_pressure(Vector<double>& y, const Vector<double>& x) const {
    if (mixed()) pressure_.divide_by_mass(1 / (1 / lambda_ + 0.5 / base_.coefficients().mu), x, y);
  }
  bool factorise(const MixedField&) { return false; }

 protected:
  using Pressures = typename PressureSpace<degree>::Coefficients;  // of a batch of cells

  OperatorWithPressures(const ElasticSystem& system, const ElasticCoefficients<double>& coefficients)
      : form_(system.form),
        lambda_(system.lambda),
        base_(*system.body.mapping, system.dof_handler, active_cells, system.constrained, coefficients),
        pressure_(base_.cells()),
        multigrid_(system, smoothed(system)) {}

  bool mixed() const { return form_ == Form::mixed; }

  // y from the gradients of x.u: at_cell(u, batch, p) submits the stress and returns the residuals of the pressures p.
  template <typename AtCell>
  void loop(MixedField& y, const MixedField& x, const AtCell& at_cell) const {
    const std::function<void(const typename Base::Cells&, Vector<double>&, const Vector<double>&,
                             const typename Base::Range&)>
        add = [&](const auto& cells, Vector<double>& force, const Vector<double>& displacement, const auto& range) {
          Cell u(cells);
          for (unsigned int batch = range.first; batch < range.second; ++batch) {
            u.reinit(batch);
            u.gather_evaluate(displacement, gradients);
            const Pressures r = at_cell(u, batch, mixed() ? pressure_.read(x.p, batch) : Pressures{});
            if (mixed()) pressure_.write(r, batch, y.p);
            u.integrate_scatter(gradients, force);
          }
        };
    base_.cells().cell_loop(add, y.u, x.u, true);
  }

 private:
  // The operator of the multigrid: the stiffness of the displacement form, or for the mixed form its shear part alone.
  static ElasticCoefficients<float> smoothed(const ElasticSystem& system) {
    if (system.form == Form::mixed) return {float(system.mu), 0, false};
    return {float(system.mu), float(system.lambda), system.form == Form::mean_dilatation};
  }

 protected:
  Form form_;
  double lambda_;
  Base base_;
  PressureSpace<degree> pressure_;
  VCycle<degree> multigrid_;
};

// [ 2 mu eps : eps   p div v       ]
// [ q div u          -p q / lambda ]
// Symmetric, indefinite; p = lambda div u, projected onto the pressure space.  Without pressures the stiffness.
template <int degree>
class LinearOperator : public OperatorWithPressures<degree, LinearOperator<degree>> {
  using Shared = OperatorWithPressures<degree, LinearOperator<degree>>;
  using Shared::base_, Shared::pressure_, Shared::mixed;
  using typename Shared::Cell, typename Shared::Lane, typename Shared::Pressures;

 public:
  explicit LinearOperator(const ElasticSystem& system)
      : Shared(system,
               {system.mu, system.form == Form::mixed ? 0 : system.lambda, system.form == Form::mean_dilatation}) {}

  /// The internal force of every degree of freedom, and the integrals of (div u - p / lambda) q.
  void apply(MixedField& y, const MixedField& x) const {
    if (!mixed()) return base_.apply(y.u, x.u);
    this->loop(y, x, [&](Cell& u, unsigned int, const Pressures& p) { return submit(u, p); });
  }

  /// f = the forces of pressures alone, where not constrained.
  void couple(Vector<double>& f, const Vector<double>& p) const {
    f = 0;
    Cell u(base_.cells());
    for (unsigned int batch = 0; batch < base_.cells().n_cell_batches(); ++batch) {
      u.reinit(batch);
      const Pressures c = pressure_.read(p, batch);
      for (unsigned int q = 0; q < Cell::static_n_q_points; ++q) {
        dealii::Tensor<2, 3, Lane> stress;
        for (int i = 0; i < 3; ++i) stress[i][i] = pressure_.value(c, q);
        u.submit_gradient(stress, q);
      }
      u.integrate_scatter(gradients, f);
    }
    f.compress(dealii::VectorOperation::add);
    base_.clear_constrained(f);
  }

 private:
  Pressures submit(Cell& u, const Pressures& p) const {
    const Lane mu = base_.coefficients().mu, compliance = 1 / this->lambda_;
    Pressures r{};
    for (unsigned int q = 0; q < Cell::static_n_q_points; ++q) {
      const auto h = u.get_gradient(q);
      const Lane pressure = pressure_.value(p, q);
      const Lane excess = (dealii::trace(h) - compliance * pressure) * u.JxW(q);
      for (int f = 0; f < pressure_.functions; ++f) r[f] += pressure_.basis[f][q] * excess;
      dealii::Tensor<2, 3, Lane> stress = mu * (h + dealii::transpose(h));
      for (int i = 0; i < 3; ++i) stress[i][i] += pressure;
      u.submit_gradient(stress, q);
    }
    return r;
  }
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
