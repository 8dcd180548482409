// The equations of a model at rest as matrices of PETSc, each process with the rows of its own nodes and pressures.
#pragma once

#include "msm/algebra/tangent.h"
#include "msm/distribution/model_part.h"
#include "msm/parallel/lattice_transfers.h"

namespace springproof {

/// The places that have equations: nodes, or places of pressures.
struct EquationNumbers {
  std::vector<int> number;  ///< per place, -1: it has none
  std::vector<int> own;     ///< places whose equations are this process', in their order
  int first = 0;            ///< number of the first of them
};

/// Numbers the places that have an equation, process by process.
/// @param owner process of each, -1: it has no equation
EquationNumbers number_equations(const std::vector<int>& owner, MPI_Comm communicator);

/// The same for the places `of_part` of them, ascending.
EquationNumbers number_equations(const std::vector<int>& owner, const std::vector<int>& of_part, MPI_Comm communicator);

/// Matrix of a tangent between free unknowns; fixed unknowns of nodes that are not fixed as a whole keep their diagonal
/// alone.
/// @param K with complete rows of the own nodes
/// @param network that it is of
/// @param fixed per unknown
PetscMatrix matrix_of(const Tangent& K, const Network& network, const EquationNumbers& nodes,
                      const std::vector<char>& fixed, MPI_Comm communicator);

/// Matrix of `unit` B between the pressures and the free unknowns.
PetscMatrix matrix_of(const NodalForms& B, double unit, const EquationNumbers& pressures, const EquationNumbers& nodes,
                      const std::vector<char>& fixed, MPI_Comm communicator);

/// Diagonal matrix of `values` of own equations.
PetscMatrix diagonal_matrix(const Eigen::VectorXd& values, const EquationNumbers& equations, MPI_Comm communicator);

/// Tells a solver of A, by the nodes' positions, what rigid motions are.
void set_rigid_motions(Mat A, const NodalVectors& own_positions, MPI_Comm communicator);

/// Vector of own values.
PetscVector vector_of(const Eigen::VectorXd& own, int block, MPI_Comm communicator);
Eigen::VectorXd values_of(Vec v);

/// How many iterations a solver took, and |b - A x| / |b| at the end.
struct PetscOutcome {
  bool converged;
  int iterations;
  double residual;
};

/// Solves A x = b, again from x where the residual that the iteration kept was not the true one.
PetscOutcome solve(KSP solver, Mat A, Vec b, Vec x, double tolerance, int max_iterations);

/// Conjugate gradients with the multigrid of a lattice's cells; without transfers, with smoothed aggregation.
PetscSolver displacement_solver(Mat A, const LatticeTransfers& transfers, MPI_Comm communicator);

/// GMRES for [A B^T; B -C] with the multigrid of both on a lattice; without transfers, with a block-triangular
/// preconditioner: smoothed aggregation for A, `schur` in place of the Schur complement.
PetscSolver mixed_solver(Mat system, Mat schur, const LatticeTransfers& transfers, MPI_Comm communicator);

/// The options of these solvers, to be overridden by the environment variable PETSC_OPTIONS.
void set_solver_options();

}  // namespace springproof
