// Matrix-free elastic stiffness (Kronbichler and Kormann 2012).  Part of elastic_solver.cpp: compiled once per vector
// width, in a namespace of that width.
#pragma once

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/matrix_free/fe_evaluation.h>
#include <deal.II/matrix_free/matrix_free.h>

#include <Eigen/SparseCore>
#include <array>
#include <utility>
#include <vector>

#include "fem_reference/solvers/mixed_field.h"

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

template <typename Number>
constexpr std::size_t lane_count = SPRINGPROOF_VECTOR_BITS > 0 ? SPRINGPROOF_VECTOR_BITS / 8 / sizeof(Number) : 1;
template <typename Number>
using Lanes = dealii::VectorizedArray<Number, lane_count<Number>>;

constexpr auto gradients = dealii::EvaluationFlags::gradients;

template <typename Number>
struct ElasticCoefficients {
  Number mu, lambda;
  bool mean_dilatation;
};

// A stiffness whose constrained rows and columns are those of the identity matrix.  `Own` has apply(y, x): the internal
// force of every degree of freedom.
template <typename Own, typename Number>
class ConstrainedStiffness : public dealii::Subscriptor {
 public:
  unsigned int m() const { return rows_; }
  Number el(unsigned int, unsigned int) const { return Number(1); }  // required by PreconditionChebyshev

  void vmult(Vector<Number>& y, const Vector<Number>& x) const {
    without_constrained(x, [&] { static_cast<const Own&>(*this).apply(y, x); });
    for (const unsigned int i : constrained_) y.local_element(i) = x.local_element(i);
  }

  // Calls f() while the constrained entries of x are zero.
  template <typename F>
  void without_constrained(const Vector<Number>& x, const F& f) const {
    auto& x_ = const_cast<Vector<Number>&>(x);
    saved_.clear();
    for (const unsigned int i : constrained_) saved_.push_back(std::exchange(x_.local_element(i), Number(0)));
    f();
    for (std::size_t k = 0; k < constrained_.size(); ++k) x_.local_element(constrained_[k]) = saved_[k];
  }

  void clear_constrained(Vector<Number>& v) const {
    for (const unsigned int i : constrained_) v.local_element(i) = 0;
  }

 protected:
  unsigned int rows_ = 0;
  std::vector<unsigned int> constrained_;  // indices among the locally owned degrees of freedom

 private:
  mutable std::vector<Number> saved_;
};

// The stiffness on one level, or on the active cells.
template <int degree, typename Number>
class Stiffness : public ConstrainedStiffness<Stiffness<degree, Number>, Number> {
 public:
  using Cell = dealii::FEEvaluation<3, degree, degree + 1, 3, Number, Lanes<Number>>;
  using Cells = dealii::MatrixFree<3, Number, Lanes<Number>>;
  using Range = std::pair<unsigned int, unsigned int>;

  Stiffness(const dealii::Mapping<3>& mapping, const dealii::DoFHandler<3>& dof_handler, unsigned int level,
            const std::vector<unsigned int>& constrained, const ElasticCoefficients<Number>& coefficients)
      : coefficients_(coefficients) {
    typename Cells::AdditionalData data;
    data.tasks_parallel_scheme = Cells::AdditionalData::none;
    data.mapping_update_flags = dealii::update_gradients | dealii::update_JxW_values;
    data.mg_level = level;
    static const dealii::AffineConstraints<double> unconstrained = [] {
      dealii::AffineConstraints<double> none;
      none.close();
      return none;
    }();
    cells_.reinit(mapping, dof_handler, unconstrained, dealii::QGauss<1>(degree + 1), data);
    const bool active = level == dealii::numbers::invalid_unsigned_int;
    this->rows_ = active ? dof_handler.n_dofs() : dof_handler.n_dofs(level);
    const dealii::IndexSet& owned =
        active ? dof_handler.locally_owned_dofs() : dof_handler.locally_owned_mg_dofs(level);
    for (const unsigned int i : constrained)
      if (owned.is_element(i)) this->constrained_.push_back(owned.index_within_set(i));
  }

  const Cells& cells() const { return cells_; }
  const ElasticCoefficients<Number>& coefficients() const { return coefficients_; }

  Vector<Number> vector() const {
    Vector<Number> v;
    cells_.initialize_dof_vector(v);
    return v;
  }

  // The internal force of every degree of freedom.
  void apply(Vector<Number>& y, const Vector<Number>& x) const {
    const std::function<void(const Cells&, Vector<Number>&, const Vector<Number>&, const Range&)> add =
        [this](const Cells& cells, Vector<Number>& to, const Vector<Number>& from, const Range& range) {
          Cell u(cells);
          for (unsigned int batch = range.first; batch < range.second; ++batch) {
            u.reinit(batch);
            u.gather_evaluate(from, gradients);
            submit_stress(u);
            u.integrate_scatter(gradients, to);
          }
        };
    cells_.cell_loop(add, y, x, true);
  }

  // K_aa of node a, component c: integral of mu |grad N|^2 + (mu + lambda) (dN/dx_c)^2.
  Vector<Number> inverse_diagonal() const {
    Vector<Number> diagonal = vector();
    const std::function<void(const Cells&, Vector<Number>&, const unsigned int&, const Range&)> add =
        [this](const Cells& cells, Vector<Number>& to, const unsigned int&, const Range& range) {
          Cell u(cells);
          for (unsigned int batch = range.first; batch < range.second; ++batch) {
            u.reinit(batch);
            set_diagonal(u);
            u.distribute_local_to_global(to);
          }
        };
    cells_.cell_loop(add, diagonal, 0u, true);
    for (const unsigned int i : this->constrained_) diagonal.local_element(i) = 1;
    for (unsigned int i = 0; i < diagonal.locally_owned_size(); ++i)
      diagonal.local_element(i) = Number(1) / diagonal.local_element(i);
    return diagonal;
  }

  // The matrix of a level as contributions of its cells; ones on the diagonal of constrained rows.
  std::vector<Eigen::Triplet<double>> entries() const {
    std::vector<char> held(this->rows_, 0);
    for (const unsigned int i : this->constrained_) held[i] = 1;
    std::vector<Eigen::Triplet<double>> entries;
    for (const unsigned int i : this->constrained_) entries.emplace_back(i, i, 1.0);
    const auto& place = cells_.get_shape_info().lexicographic_numbering;
    std::vector<dealii::types::global_dof_index> numbers(Cell::static_dofs_per_cell);
    Cell u(cells_);
    for (unsigned int batch = 0; batch < cells_.n_cell_batches(); ++batch) {
      const unsigned int lanes = cells_.n_active_entries_per_cell_batch(batch);
      std::array<std::array<unsigned int, Cell::static_dofs_per_cell>, Lanes<Number>::size()> row;
      for (unsigned int lane = 0; lane < lanes; ++lane) {
        cells_.get_cell_iterator(batch, lane)->get_mg_dof_indices(numbers);
        for (unsigned int i = 0; i < Cell::static_dofs_per_cell; ++i) row[lane][i] = unsigned(numbers[place[i]]);
      }
      u.reinit(batch);
      for (unsigned int j = 0; j < Cell::static_dofs_per_cell; ++j) {
        for (unsigned int i = 0; i < Cell::static_dofs_per_cell; ++i) u.begin_dof_values()[i] = Number(i == j);
        u.evaluate(gradients);
        submit_stress(u);
        u.integrate(gradients);
        for (unsigned int lane = 0; lane < lanes; ++lane)
          for (unsigned int i = 0; i < Cell::static_dofs_per_cell; ++i)
            if (!held[row[lane][i]] && !held[row[lane][j]])
              entries.emplace_back(row[lane][i], row[lane][j], u.begin_dof_values()[i][lane]);
      }
    }
    return entries;
  }

  // Switches to the stiffness of the body deformed by u, integrated over the rest volume: gradients are taken in the
  // deformed configuration.  Quadrature points with det F < 0.05 keep the rest configuration.
  void deform(const Vector<Number>& displacement) {
    to_rest_.resize(cells_.n_cell_batches() * Cell::static_n_q_points);
    displacement.update_ghost_values();
    Cell u(cells_);
    for (unsigned int batch = 0; batch < cells_.n_cell_batches(); ++batch) {
      u.reinit(batch);
      u.gather_evaluate(displacement, gradients);
      for (unsigned int q = 0; q < Cell::static_n_q_points; ++q) {
        auto F = u.get_gradient(q);
        for (int i = 0; i < 3; ++i) F[i][i] += Number(1);
        const Lanes<Number> J = dealii::determinant(F);
        for (std::size_t lane = 0; lane < Lanes<Number>::size(); ++lane)
          if (J[lane] < Number(0.05))
            for (int i = 0; i < 3; ++i)
              for (int j = 0; j < 3; ++j) F[i][j][lane] = i == j;
        to_rest_[batch * Cell::static_n_q_points + q] = dealii::invert(F);
      }
    }
    displacement.zero_out_ghost_values();
  }

 private:
  // Displacement gradient in the deformed configuration.
  dealii::Tensor<2, 3, Lanes<Number>> gradient(const Cell& u, unsigned int q) const {
    const dealii::Tensor<2, 3, Lanes<Number>> h = u.get_gradient(q);
    return to_rest_.empty() ? h : h * to_rest(u, q);
  }

  const dealii::Tensor<2, 3, Lanes<Number>>& to_rest(const Cell& u, unsigned int q) const {
    return to_rest_[u.get_current_cell_index() * Cell::static_n_q_points + q];
  }

  void submit_stress(Cell& u) const {
    const Lanes<Number> mu = coefficients_.mu, lambda = coefficients_.lambda;
    Lanes<Number> mean = Number(0), volume = Number(0);
    if (coefficients_.mean_dilatation) {
      for (unsigned int q = 0; q < Cell::static_n_q_points; ++q) {
        mean += dealii::trace(gradient(u, q)) * u.JxW(q);
        volume += u.JxW(q);
      }
      mean /= volume;
    }
    for (unsigned int q = 0; q < Cell::static_n_q_points; ++q) {
      const auto h = gradient(u, q);
      const Lanes<Number> pressure = lambda * (coefficients_.mean_dilatation ? mean : h[0][0] + h[1][1] + h[2][2]);
      dealii::Tensor<2, 3, Lanes<Number>> stress;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) stress[i][j] = mu * (h[i][j] + h[j][i]);
      for (int i = 0; i < 3; ++i) stress[i][i] += pressure;
      if (!to_rest_.empty()) stress = stress * dealii::transpose(to_rest(u, q));
      u.submit_gradient(stress, q);
    }
  }

  void set_diagonal(Cell& u) const {
    constexpr int n = degree + 1;
    const auto& shape = u.get_shape_info().data[0];
    const auto value = [&](int i, int q) { return shape.shape_values[i * n + q]; };
    const auto slope = [&](int i, int q) { return shape.shape_gradients[i * n + q]; };
    const Lanes<Number> mu = coefficients_.mu, lambda = coefficients_.lambda;
    for (int a = 0; a < n * n * n; ++a) {
      const int i = a % n, j = a / n % n, k = a / (n * n);
      dealii::Tensor<1, 3, Lanes<Number>> squares, mean;
      Lanes<Number> volume = Number(0);
      for (int q = 0; q < n * n * n; ++q) {
        const int qx = q % n, qy = q / n % n, qz = q / (n * n);
        dealii::Tensor<1, 3, Lanes<Number>> unit;
        unit[0] = slope(i, qx) * value(j, qy) * value(k, qz);
        unit[1] = value(i, qx) * slope(j, qy) * value(k, qz);
        unit[2] = value(i, qx) * value(j, qy) * slope(k, qz);
        auto dN = u.inverse_jacobian(q) * unit;
        if (!to_rest_.empty()) dN = dealii::transpose(to_rest(u, q)) * dN;
        const Lanes<Number> JxW = u.JxW(q);
        for (int c = 0; c < 3; ++c) {
          squares[c] += JxW * dN[c] * dN[c];
          mean[c] += JxW * dN[c];
        }
        volume += JxW;
      }
      const Lanes<Number> all = squares[0] + squares[1] + squares[2];
      for (int c = 0; c < 3; ++c) {
        const Lanes<Number> dilatation =
            coefficients_.mean_dilatation ? Lanes<Number>(mean[c] * mean[c] / volume) : squares[c];
        u.begin_dof_values()[c * n * n * n + a] = mu * (all + squares[c]) + lambda * dilatation;
      }
    }
  }

  Cells cells_;
  dealii::AlignedVector<dealii::Tensor<2, 3, Lanes<Number>>> to_rest_;  // inverse deformation gradient, or empty
  ElasticCoefficients<Number> coefficients_;
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
