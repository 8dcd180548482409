// The elastic problem on one grid as the solvers see it.
#pragma once

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <functional>
#include <string>
#include <vector>

#include "fem_reference/element.h"
#include "fem_reference/laws.h"
#include "fem_reference/triangulate.h"

namespace springproof::fem {

using DofVector = dealii::LinearAlgebra::distributed::Vector<double>;

using LevelVector = dealii::LinearAlgebra::distributed::Vector<float>;  ///< on a level of the matrix-free multigrid

/// Zero on every degree of freedom, with room for those of other processes on the cells of this one and around them.
inline DofVector zero_vector(const dealii::DoFHandler<3>& dof_handler) {
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
  return DofVector(dof_handler.locally_owned_dofs(), relevant, dof_handler.get_communicator());
}

/// Of an Eigen matrix, entry by entry, on every process.
template <typename Matrix>
void sum_over_processes(Matrix& m, MPI_Comm comm) {
  const dealii::ArrayView<double> values(m.data(), m.size());
  dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(values), comm, values);
}

/// The pressure in each active cell as a + b.xi, xi in the reference cell: (a, b_1, b_2, b_3) [Pa];
/// zero in the cells of other processes.
using CellPressures = std::vector<std::array<double, 4>>;

/// Factors of 3-D bodies grow with the power 4/3 of the unknowns, their cost with 2; at so many they cost as much as
/// solving by GAMG a few times, on cubes.  Thin and ragged bodies, where GAMG is at its worst, have the smallest.
constexpr int most_factored_rows = 40000;

struct ElasticSystem {
  const Body3& body;
  const dealii::DoFHandler<3>& dof_handler;  ///< with level degrees of freedom, if solved without a matrix
  std::vector<unsigned int> constrained;     ///< degrees of freedom with prescribed value, on the cells of this process
                                             ///  and around them
  std::vector<dealii::IndexSet> level_constrained;  ///< the same on every level; empty: solved with a matrix
  int degree;
  Form form;
  double mu, lambda;  ///< [Pa]
  double tolerance;   ///< relative residual
  bool wide_vectors;  ///< where the processor has them
  bool plain_gamg;    ///< with matrices: no level of linear elements
  int most_factored;  ///< with matrices: rows up to which that of linear elements is factored
  std::function<void(LevelVector& x, const LevelVector& r)> below =
      {};  ///< a correction of the coarsest level by something coarser;
           ///  empty: nothing is
};

struct ElasticAnswer {
  DofVector internal_force;  ///< on every degree of freedom, the constrained ones too [N]
  int iterations = 0;
  double residual = 0;  ///< |free part of load - internal force| / forces at work (at the start, or reactions)
  bool converged = false;
  CellPressures pressure;   ///< of the mixed form, else empty
  double load_reached = 1;  ///< fraction of the load that internal_force balances
  std::string method;
};

/// Solves for the free part of `displacement`, whose constrained entries hold the prescribed values.
ElasticAnswer solve_elastic(const ElasticSystem& system, const DofVector& load, DofVector& displacement);

/// What finite strain adds.
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

/// Total Lagrangian Newton's method; the load is dead.  If it fails, the answer is that of the load reached.
FiniteAnswer solve_finite(const ElasticSystem& system, const FiniteProblem& problem, const DofVector& load,
                          DofVector& displacement);

}  // namespace springproof::fem
