// The discrete elastic problem on one grid, the input of the solvers.
#pragma once

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <functional>
#include <string>
#include <vector>

#include "fem_reference/elements/cell_equations.h"
#include "fem_reference/elements/element.h"
#include "fem_reference/elements/laws.h"
#include "fem_reference/grid/triangulate.h"

namespace springproof::fem {

using DofVector = dealii::LinearAlgebra::distributed::Vector<double>;

using LevelVector = dealii::LinearAlgebra::distributed::Vector<float>;  ///< on a level of the matrix-free multigrid

/// A zero vector with ghost entries for the locally relevant degrees of freedom.
inline DofVector zero_vector(const dealii::DoFHandler<3>& dof_handler) {
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
  return DofVector(dof_handler.locally_owned_dofs(), relevant, dof_handler.get_communicator());
}

/// Gradients and weights of scalar elements in the cell that `values` are of.
inline void set_shape(const dealii::FEValues<3>& values, CellShape& shape) {
  const int n = int(values.dofs_per_cell), points = int(values.n_quadrature_points);
  shape.gradients.resize(3 * points, n);
  shape.weights.resize(points);
  for (int q = 0; q < points; ++q) {
    shape.weights[q] = values.JxW(q);
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < 3; ++i) shape.gradients(3 * q + i, a) = values.shape_grad(a, q)[i];
  }
}

/// Sums an Eigen matrix over all processes, entry by entry; every process gets the result.
template <typename Matrix>
void sum_over_processes(Matrix& m, MPI_Comm comm) {
  const dealii::ArrayView<double> values(m.data(), m.size());
  dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(values), comm, values);
}

/// The pressure in each active cell as a + b.xi, xi in the reference cell: (a, b_1, b_2, b_3) [Pa];
/// zero in the cells of other processes.
using CellPressures = std::vector<std::array<double, 4>>;

/// For n unknowns in 3-D, Cholesky factors grow as n^(4/3) and their cost as n^2; at this many rows, on cubes, they
/// cost as much as a few solves by GAMG.  Thin and ragged bodies, for which GAMG performs worst, have the smallest
/// factors.
constexpr int most_factored_rows = 40000;
/// The same of quadratic elements where the multigrid stalls.
constexpr int most_factored_for_thin_bodies = 100000;

struct ElasticSystem {
  const Body3& body;
  const dealii::DoFHandler<3>& dof_handler;  ///< with level degrees of freedom, if solved matrix-free
  int degree;
  Form form;
  double mu, lambda;                           ///< [Pa]
  std::vector<unsigned int> constrained = {};  ///< degrees of freedom with prescribed value, locally owned and ghost
  std::vector<dealii::IndexSet> level_constrained =
      {};                     ///< the same on every level; empty: solved with assembled matrices
  double tolerance = 1e-9;    ///< relative residual
  bool wide_vectors = false;  ///< use wide SIMD vectors where the processor has them
  bool plain_gamg = false;    ///< assembled matrices: no level of linear elements
  int most_factored =
      most_factored_rows;  ///< assembled matrices: largest number of rows for which linear elements are factored
  std::function<void(LevelVector& x, const LevelVector& r)> below =
      {};                          ///< coarse-grid correction of the coarsest level; empty: none
  std::string below_name = {};     ///< its method, for the report
  double pointwise = 0;            ///< CellLaw::pointwise [Pa]
  std::vector<CellLaw> laws = {};  ///< of cells by their material_id, of a body of several materials; else empty

  /// Of the cells of this material_id.
  CellLaw law_of(unsigned int material, std::optional<Law> law) const {
    return laws.empty() ? CellLaw{law, form, mu, lambda, pointwise} : laws.at(material);
  }
};

struct ElasticAnswer {
  DofVector internal_force;  ///< on every degree of freedom, including constrained ones [N]
  int iterations = 0;
  double residual = 0;  ///< |unconstrained part of load - internal force| / (initial residual, or reactions)
  bool converged = false;
  CellPressures pressure;   ///< of the mixed form, else empty
  double load_reached = 1;  ///< fraction of the load that internal_force balances
  std::string method;
};

/// Additional data for finite strain.
struct FiniteProblem {
  Law law;
  /// Sets the prescribed entries to their values at a fraction of the load; all others to zero.
  std::function<void(double factor, DofVector& displacement)> prescribe;
  double first_step = 1;            ///< fraction of the load
  double smallest_step = 1. / 512;  ///< steps that fail are halved down to this
};

struct FiniteAnswer : ElasticAnswer {
  double min_jacobian = 1;
  int newton_iterations = 0, load_steps = 0;
};

/// Solvers for the unconstrained entries of `displacement`, of one kind of operators.
struct Solvers {
  /// The constrained entries hold the prescribed values.
  ElasticAnswer (*elastic)(const ElasticSystem& system, const DofVector& load, DofVector& displacement);
  /// Newton's method, total Lagrangian, with dead loads.  If it fails, the result is that at the load reached.
  FiniteAnswer (*finite)(const ElasticSystem& system, const FiniteProblem& problem, const DofVector& load,
                         DofVector& displacement);
};

}  // namespace springproof::fem
