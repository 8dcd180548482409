// Displacement and pressure.  Part of elastic_solver.cpp, as stiffness.h.
#pragma once

#include "fem_reference/stiffness.h"
#include "fem_reference/v_cycle.h"

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

struct MixedVector {
  Vector<double> u;  ///< displacement, or force
  Vector<double> p;  ///< coefficients per cell batch, function and lane

  void add(double factor, const MixedVector& other) {
    u.add(factor, other.u);
    p.add(factor, other.p);
  }
  /// this = this * s + other * t
  void sadd(double s, double t, const MixedVector& other) {
    u.sadd(s, t, other.u);
    p.sadd(s, t, other.p);
  }
  double dot(const MixedVector& other) const { return u * other.u + p * other.p; }
};

// [ 2 mu eps : eps   p div v      ]   symmetric, indefinite; p = lambda div u, projected on 1 (and the three
// [ q div u          -p q / lambda ]   coordinates of the reference cell, for Q2).
template <int degree>
class MixedOperator {
 public:
  using Shear = Stiffness<degree, double>;
  using Cell = typename Shear::Cell;
  using Lane = Lanes<double>;
  static constexpr int functions = degree == 1 ? 1 : 4;

  MixedOperator(const Shear& shear, double lambda) : shear_(shear), lambda_(lambda) {
    inverse_mass_.reinit(pressures());
    Cell u(shear_.cells());
    for (unsigned int batch = 0; batch < shear_.cells().n_cell_batches(); ++batch) {
      u.reinit(batch);
      std::array<Lane, functions> mass{};
      for (unsigned int q = 0; q < Cell::static_n_q_points; ++q)
        for (int f = 0; f < functions; ++f) mass[f] += basis_[f][q] * basis_[f][q] * u.JxW(q);
      for (int f = 0; f < functions; ++f)
        for (unsigned int lane = 0; lane < shear_.cells().n_active_entries_per_cell_batch(batch); ++lane)
          inverse_mass_.local_element((batch * functions + f) * Lane::size() + lane) = 1 / mass[f][lane];
    }
  }

  MixedVector vector() const {
    MixedVector x;
    x.u = shear_.vector();
    x.p.reinit(pressures());
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
        add = [&](const auto& cells, Vector<double>& force, const Vector<double>& displacement,
                  const auto& range) {
          Cell u(cells);
          for (unsigned int batch = range.first; batch < range.second; ++batch) {
            u.reinit(batch);
            u.gather_evaluate(displacement, gradients);
            submit(u, batch, x.p, y.p);
            u.integrate_scatter(gradients, force);
          }
        };
    shear_.cells().cell_loop(add, y.u, x.u, true);
  }

  /// Multiplies the pressure by (M (1/lambda + 1/(2 mu)))^-1, with the diagonal of the mass matrix M.
  void precondition_pressure(Vector<double>& y, const Vector<double>& x) const {
    const double scale = 1 / (1 / lambda_ + 0.5 / shear_.coefficients().mu);
    for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
      y.local_element(i) = scale * inverse_mass_.local_element(i) * x.local_element(i);
  }

 private:
  using Basis = std::array<std::array<double, Cell::static_n_q_points>, functions>;

  static Basis make_basis() {
    const dealii::QGauss<3> quadrature(degree + 1);
    Basis basis;
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      for (int f = 0; f < functions; ++f) basis[f][q] = f == 0 ? 1 : 2 * quadrature.point(q)[f - 1] - 1;
    return basis;
  }

  unsigned int pressures() const { return shear_.cells().n_cell_batches() * functions * Lane::size(); }

  void submit(Cell& u, unsigned int batch, const Vector<double>& p_from, Vector<double>& r_to) const {
    const Lane mu = shear_.coefficients().mu, compliance = 1 / lambda_;
    std::array<Lane, functions> p, r{};
    for (int f = 0; f < functions; ++f) p[f].load(p_from.begin() + (batch * functions + f) * Lane::size());
    for (unsigned int q = 0; q < Cell::static_n_q_points; ++q) {
      const auto h = u.get_gradient(q);
      Lane pressure = p[0];
      for (int f = 1; f < functions; ++f) pressure += p[f] * basis_[f][q];
      const Lane excess = (h[0][0] + h[1][1] + h[2][2] - compliance * pressure) * u.JxW(q);
      for (int f = 0; f < functions; ++f) r[f] += basis_[f][q] * excess;
      dealii::Tensor<2, 3, Lane> stress;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) stress[i][j] = mu * (h[i][j] + h[j][i]);
      for (int i = 0; i < 3; ++i) stress[i][i] += pressure;
      u.submit_gradient(stress, q);
    }
    for (int f = 0; f < functions; ++f) r[f].store(r_to.begin() + (batch * functions + f) * Lane::size());
  }

  const Shear& shear_;
  double lambda_;
  Basis basis_ = make_basis();
  Vector<double> inverse_mass_;
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
