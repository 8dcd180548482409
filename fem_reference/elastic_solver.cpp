// Matrix-free solver of the linear-elastic system.  This file is compiled once per vector width.
//
// Debian's deal.II is built without vectorisation; defining the width here, after config.h, makes the wide
// VectorizedArray types exist in this file while the library's default stays one lane.  What the library
// lacks for the wide types is instantiated from its own template files.
#include <deal.II/base/config.h>
#if SPRINGPROOF_VECTOR_BITS > 0
#undef DEAL_II_VECTORIZATION_WIDTH_IN_BITS
#define DEAL_II_VECTORIZATION_WIDTH_IN_BITS SPRINGPROOF_VECTOR_BITS
#endif
#include <deal.II/base/vectorization.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/matrix_free/fe_evaluation.h>
#include <deal.II/matrix_free/matrix_free.h>
#include <deal.II/multigrid/mg_constrained_dofs.h>
#include <deal.II/multigrid/mg_transfer_matrix_free.h>
#if SPRINGPROOF_VECTOR_BITS > 0
#define FE_EVAL_FACTORY_DEGREE_MAX 2
#include <deal.II/matrix_free/dof_info.templates.h>
#include <deal.II/matrix_free/evaluation_template_face_factory.templates.h>
#include <deal.II/matrix_free/evaluation_template_factory.templates.h>
#include <deal.II/matrix_free/evaluation_template_factory_hanging_nodes.templates.h>
#include <deal.II/matrix_free/mapping_info.templates.h>
#include <deal.II/matrix_free/matrix_free.templates.h>
#include <deal.II/matrix_free/shape_info.templates.h>
#endif

#include "fem_reference/elastic_system.h"

namespace springproof::fem {
namespace SPRINGPROOF_SOLVER_NAMESPACE {
namespace {

template <typename Number>
constexpr std::size_t lane_count = SPRINGPROOF_VECTOR_BITS > 0 ? SPRINGPROOF_VECTOR_BITS / 8 / sizeof(Number)
                                                               : 1;
template <typename Number>
using Lanes = dealii::VectorizedArray<Number, lane_count<Number>>;
template <typename Number>
using Vector = dealii::LinearAlgebra::distributed::Vector<Number>;

constexpr auto gradients = dealii::EvaluationFlags::gradients;

template <typename Number>
struct Coefficients {
  Number mu, lambda;
  bool mean_dilatation;
};

// The stiffness on one level, or on the active cells.  Constrained rows and columns are those of the
// identity.
template <int degree, typename Number>
class Stiffness : public dealii::Subscriptor {
 public:
  using Cell = dealii::FEEvaluation<3, degree, degree + 1, 3, Number, Lanes<Number>>;
  using Cells = dealii::MatrixFree<3, Number, Lanes<Number>>;
  using Range = std::pair<unsigned int, unsigned int>;

  Stiffness(const dealii::DoFHandler<3>& dof_handler, unsigned int level,
            std::vector<unsigned int> constrained, const Coefficients<Number>& coefficients)
      : constrained_(std::move(constrained)), coefficients_(coefficients), saved_(constrained_.size()) {
    typename Cells::AdditionalData data;
    data.tasks_parallel_scheme = Cells::AdditionalData::none;
    data.mapping_update_flags = dealii::update_gradients | dealii::update_JxW_values;
    data.mg_level = level;
    static const dealii::AffineConstraints<double> unconstrained = [] {
      dealii::AffineConstraints<double> none;
      none.close();
      return none;
    }();
    cells_.reinit(dealii::MappingQ1<3>(), dof_handler, unconstrained, dealii::QGauss<1>(degree + 1), data);
    rows_ = level == dealii::numbers::invalid_unsigned_int ? dof_handler.n_dofs() : dof_handler.n_dofs(level);
  }

  const Cells& cells() const { return cells_; }
  const Coefficients<Number>& coefficients() const { return coefficients_; }
  const std::vector<unsigned int>& constrained() const { return constrained_; }
  unsigned int m() const { return rows_; }
  Number el(unsigned int, unsigned int) const {
    return Number(1);
  }  // asked for by PreconditionChebyshev's interface

  Vector<Number> vector() const {
    Vector<Number> v;
    cells_.initialize_dof_vector(v);
    return v;
  }

  void vmult(Vector<Number>& y, const Vector<Number>& x) const {
    without_constrained(x, [&] { apply(y, x); });
    for (std::size_t i = 0; i < constrained_.size(); ++i) y.local_element(constrained_[i]) = saved_[i];
  }

  // f() while the constrained entries of x are zero.
  template <typename F>
  void without_constrained(const Vector<Number>& x, const F& f) const {
    auto& x_ = const_cast<Vector<Number>&>(x);
    for (std::size_t i = 0; i < constrained_.size(); ++i) {
      saved_[i] = x.local_element(constrained_[i]);
      x_.local_element(constrained_[i]) = 0;
    }
    f();
    for (std::size_t i = 0; i < constrained_.size(); ++i) x_.local_element(constrained_[i]) = saved_[i];
  }

  void clear_constrained(Vector<Number>& v) const {
    for (const unsigned int i : constrained_) v.local_element(i) = 0;
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
    for (const unsigned int i : constrained_) diagonal.local_element(i) = 1;
    for (unsigned int i = 0; i < diagonal.locally_owned_size(); ++i)
      diagonal.local_element(i) = Number(1) / diagonal.local_element(i);
    return diagonal;
  }

 private:
  void submit_stress(Cell& u) const {
    const Lanes<Number> mu = coefficients_.mu, lambda = coefficients_.lambda;
    Lanes<Number> mean = Number(0), volume = Number(0);
    if (coefficients_.mean_dilatation) {
      for (unsigned int q = 0; q < Cell::static_n_q_points; ++q) {
        mean += u.get_divergence(q) * u.JxW(q);
        volume += u.JxW(q);
      }
      mean /= volume;
    }
    for (unsigned int q = 0; q < Cell::static_n_q_points; ++q) {
      const auto h = u.get_gradient(q);
      const Lanes<Number> pressure =
          lambda * (coefficients_.mean_dilatation ? mean : h[0][0] + h[1][1] + h[2][2]);
      dealii::Tensor<2, 3, Lanes<Number>> stress;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) stress[i][j] = mu * (h[i][j] + h[j][i]);
      for (int i = 0; i < 3; ++i) stress[i][i] += pressure;
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
        const auto dN = u.inverse_jacobian(q) * unit;
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
  std::vector<unsigned int> constrained_;
  Coefficients<Number> coefficients_;
  mutable std::vector<Number> saved_;
  unsigned int rows_;
};

// A symmetric V-cycle in single precision, Chebyshev smoothing.
template <int degree>
class VCycle {
 public:
  using Level = Stiffness<degree, float>;
  using Smoother = dealii::PreconditionChebyshev<Level, Vector<float>>;

  VCycle(const ElasticSystem& system, const Coefficients<float>& coefficients)
      : dof_handler_(system.dof_handler) {
    const unsigned int n_levels = dof_handler_.get_triangulation().n_levels();
    constrained_dofs_.initialize(dof_handler_);
    for (unsigned int l = 0; l < n_levels; ++l)
      constrained_dofs_.add_boundary_indices(dof_handler_, l, system.level_constrained[l]);
    transfer_.initialize_constraints(constrained_dofs_);
    transfer_.build(dof_handler_);
    x_.resize(0, n_levels - 1);
    b_.resize(0, n_levels - 1);
    t_.resize(0, n_levels - 1);
    for (unsigned int l = 0; l < n_levels; ++l) {
      std::vector<unsigned int> constrained;
      for (const auto i : system.level_constrained[l]) constrained.push_back(i);
      levels_.push_back(std::make_unique<Level>(dof_handler_, l, std::move(constrained), coefficients));
      smoothers_.push_back(std::make_unique<Smoother>());
      smoothers_.back()->initialize(*levels_.back(), smoother_data(l));
      x_[l] = b_[l] = t_[l] = levels_.back()->vector();
    }
  }

  void vmult(Vector<double>& y, const Vector<double>& x) const {
    transfer_.copy_to_mg(dof_handler_, b_, x);
    cycle(levels_.size() - 1);
    transfer_.copy_from_mg(dof_handler_, y, x_);
  }

 private:
  typename Smoother::AdditionalData smoother_data(unsigned int level) const {
    typename Smoother::AdditionalData data;
    const bool solves = level == 0 && levels_[0]->m() < largest_coarse_system;
    data.degree = solves ? dealii::numbers::invalid_unsigned_int : 5;
    data.smoothing_range = solves ? 1e-2 : 15;
    data.eig_cg_n_iterations = solves ? levels_[0]->m() : 12;
    data.preconditioner =
        std::make_shared<dealii::DiagonalMatrix<Vector<float>>>(levels_[level]->inverse_diagonal());
    return data;
  }

  // x_[l] from b_[l]
  void cycle(unsigned int l) const {
    smoothers_[l]->vmult(x_[l], b_[l]);
    if (l == 0) return;
    levels_[l]->vmult(t_[l], x_[l]);
    t_[l].sadd(-1, 1, b_[l]);
    b_[l - 1] = 0;
    transfer_.restrict_and_add(l, b_[l - 1], t_[l]);
    cycle(l - 1);
    transfer_.prolongate(l, t_[l], x_[l - 1]);
    x_[l] += t_[l];
    smoothers_[l]->step(x_[l], b_[l]);
  }

  static constexpr unsigned int largest_coarse_system = 20000;

  const dealii::DoFHandler<3>& dof_handler_;
  dealii::MGConstrainedDoFs constrained_dofs_;
  dealii::MGTransferMatrixFree<3, float> transfer_;
  std::vector<std::unique_ptr<Level>> levels_;
  std::vector<std::unique_ptr<Smoother>> smoothers_;
  mutable dealii::MGLevelObject<Vector<float>> x_, b_, t_;
};

template <int degree>
ElasticAnswer solve_displacement_form(const ElasticSystem& system, const DofVector& load, DofVector& u) {
  const bool mean = system.form == Form::mean_dilatation;
  const Stiffness<degree, double> K(system.dof_handler, dealii::numbers::invalid_unsigned_int,
                                    system.constrained, {system.mu, system.lambda, mean});
  const VCycle<degree> multigrid(system, {float(system.mu), float(system.lambda), mean});

  ElasticAnswer answer;
  answer.method = "CG, matrix-free multigrid";
  Vector<double> x = K.vector(), r = K.vector(), du = K.vector();
  x = u;
  answer.internal_force.reinit(r);
  double start = 0;
  for (int repeat = 0; repeat < 4; ++repeat) {
    K.apply(answer.internal_force, x);
    r = load;
    r -= answer.internal_force;
    K.clear_constrained(r);
    const double norm = r.l2_norm();
    if (repeat == 0) start = norm;
    answer.residual = start > 0 ? norm / start : 0;
    answer.converged = answer.residual <= system.tolerance;
    if (answer.converged || repeat == 3) break;
    dealii::SolverControl control(1000, 0.5 * system.tolerance * start);
    dealii::SolverCG<Vector<double>> cg(control);
    du = 0;
    try {
      cg.solve(K, du, r, multigrid);
    } catch (const dealii::SolverControl::NoConvergence&) {
    }
    answer.iterations += control.last_step();
    x += du;
  }
  u = x;
  return answer;
}

}  // namespace

ElasticAnswer solve(const ElasticSystem& system, const DofVector& load, DofVector& displacement) {
  return system.degree == 1 ? solve_displacement_form<1>(system, load, displacement)
                            : solve_displacement_form<2>(system, load, displacement);
}

}  // namespace SPRINGPROOF_SOLVER_NAMESPACE
}  // namespace springproof::fem
