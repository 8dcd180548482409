// Norm and preconditioner of systems that may have pressures as unknowns.  Part of each solver, like mixed_field.h.
#pragma once

#include "fem_reference/solvers/mixed_field.h"
#include "fem_reference/system/elastic_system.h"

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

/// Dot product of residuals [N^2]: those of the dilatation equation [m^3] count as forces, 2 mu / h [N/m^3] times as
/// much, h the mean diameter of the cells.
class ResidualProduct {
 public:
  explicit ResidualProduct(const ElasticSystem& system) {
    if (system.form != Form::mixed) return;
    double diameters = 0, cells = 0;
    for (const auto& cell : system.body.triangulation.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      diameters += cell->diameter();
      ++cells;
    }
    const MPI_Comm comm = system.body.triangulation.get_communicator();
    const double h = dealii::Utilities::MPI::sum(diameters, comm) / dealii::Utilities::MPI::sum(cells, comm);
    weight_ = std::pow(2 * system.mu / h, 2);
  }
  double operator()(const MixedField& a, const MixedField& b) const { return a.u * b.u + weight_ * (a.p * b.p); }

 private:
  double weight_ = 0;
};

/// y = M^-1 x by four steps of Chebyshev's method with the diagonal, for eigenvalues from 1/2 to 5/2, the bounds for
/// linear tetrahedra (Wathen 1987); they leave an error of 4 %.  `multiply(y, x)`: by the mass matrix M.
template <typename Multiply>
void divide_by_mass_matrix(const Multiply& multiply, const Vector<double>& inverse_diagonal, const Vector<double>& x,
                           Vector<double>& y) {
  constexpr double middle = 1.5, half_width = 1;
  y = x;
  y.scale(inverse_diagonal);
  y *= 1 / middle;
  Vector<double> change = y, r = x;
  double rho = half_width / middle;
  for (int k = 1; k < 4; ++k) {
    multiply(r, y);
    r.sadd(-1, 1, x);
    r.scale(inverse_diagonal);
    const double next = 1 / (2 * middle / half_width - rho);
    change.sadd(next * rho, 2 * next / half_width, r);
    y += change;
    rho = next;
  }
}

/// z = P^-1 r.  Of [ A B^T; B -C ] the upper triangle P = [ A' B^T; 0 -S' ], with A' from the multigrid and S' a
/// pressure mass matrix in place of the Schur complement: half the iterations of diag(A', S') (Elman, Silvester, Wathen
/// 2014, section 9.2).  Without pressures A' alone.
template <typename Operator>
class BlockTriangular {
 public:
  BlockTriangular(const Operator& K, const ElasticSystem& system)
      : K_(K), mixed_(system.form == Form::mixed), rest_(K.vector().u) {}

  void operator()(MixedField& z, const MixedField& r) const {
    if (!mixed_) return K_.precondition_displacement(z.u, r.u);
    K_.precondition_pressure(z.p, r.p);
    z.p *= -1;
    K_.couple(rest_, z.p);
    rest_.sadd(-1, 1, r.u);
    K_.precondition_displacement(z.u, rest_);
  }

 private:
  const Operator& K_;
  bool mixed_;
  mutable Vector<double> rest_;
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
