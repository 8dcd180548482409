// Matrix-free mixed displacement-pressure operator.  Part of elastic_solver.cpp, like stiffness.h.
#pragma once

#include "fem_reference/grid/processes.h"
#include "fem_reference/solvers/mixed_vector.h"
#include "fem_reference/solvers/stiffness.h"
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

// [ 2 mu eps : eps   p div v       ]
// [ q div u          -p q / lambda ]
// Symmetric, indefinite; p = lambda div u, projected onto the pressure space.
template <int degree>
class MixedOperator {
 public:
  using Shear = Stiffness<degree, double>;
  using Cell = typename Shear::Cell;
  using Lane = Lanes<double>;

  MixedOperator(const Shear& shear, double lambda) : shear_(shear), pressure_(shear.cells()), lambda_(lambda) {}

  MixedVector vector() const {
    MixedVector x;
    x.u = shear_.vector();
    x.p.reinit(pressure_.inverse_mass);
    return x;
  }

  void vmult(MixedVector& y, const MixedVector& x) const {
    shear_.without_constrained(x.u, [&] { apply(y, x); });
    shear_.clear_constrained(y.u);
  }

  /// The internal force of every degree of freedom, and the integrals of (div u - p / lambda) q.
  void apply(MixedVector& y, const MixedVector& x) const {
    const std::function<void(const typename Shear::Cells&, Vector<double>&, const Vector<double>&,
                             const typename Shear::Range&)>
        add = [&](const auto& cells, Vector<double>& force, const Vector<double>& displacement, const auto& range) {
          Cell u(cells);
          for (unsigned int batch = range.first; batch < range.second; ++batch) {
            u.reinit(batch);
            u.gather_evaluate(displacement, gradients);
            pressure_.write(submit(u, pressure_.read(x.p, batch)), batch, y.p);
            u.integrate_scatter(gradients, force);
          }
        };
    shear_.cells().cell_loop(add, y.u, x.u, true);
  }

  /// f = the forces of pressures alone, where not constrained.
  void couple(Vector<double>& f, const Vector<double>& p) const {
    f = 0;
    Cell u(shear_.cells());
    for (unsigned int batch = 0; batch < shear_.cells().n_cell_batches(); ++batch) {
      u.reinit(batch);
      const auto c = pressure_.read(p, batch);
      for (unsigned int q = 0; q < Cell::static_n_q_points; ++q) {
        dealii::Tensor<2, 3, Lane> stress;
        for (int i = 0; i < 3; ++i) stress[i][i] = pressure_.value(c, q);
        u.submit_gradient(stress, q);
      }
      u.integrate_scatter(gradients, f);
    }
    f.compress(dealii::VectorOperation::add);
    shear_.clear_constrained(f);
  }

  CellPressures pressures(const MixedVector& x) const { return pressure_.per_cell(shear_.cells(), x.p); }

  /// Multiplies by (M (1/lambda + 1/(2 mu)))^-1, an approximate inverse of the Schur complement.
  void precondition_pressure(Vector<double>& y, const Vector<double>& x) const {
    pressure_.divide_by_mass(1 / (1 / lambda_ + 0.5 / shear_.coefficients().mu), x, y);
  }

 private:
  typename PressureSpace<degree>::Coefficients submit(Cell& u,
                                                      const typename PressureSpace<degree>::Coefficients& p) const {
    const Lane mu = shear_.coefficients().mu, compliance = 1 / lambda_;
    typename PressureSpace<degree>::Coefficients r{};
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

  const Shear& shear_;
  PressureSpace<degree> pressure_;
  double lambda_;
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
