#include "comparisons/bench/gamg.h"

#include <stdexcept>

#include "problem/processes/mpi_start.h"
#include "problem/system/run_cost.h"

#ifdef SPRINGPROOF_PETSC
#include "msm/parallel/parted_equations.h"
#endif

namespace springproof::bench {

#ifndef SPRINGPROOF_PETSC
bool has_gamg() { return false; }
GamgResult solve_gamg(const MassSpringModel&, const BoundaryConditions&, double, const NodalVectors&) {
  throw std::runtime_error("this program was built without PETSc");
}
#else
bool has_gamg() { return true; }

GamgResult solve_gamg(const MassSpringModel& model, const BoundaryConditions& conditions, double tolerance,
                      const NodalVectors& other) {
  start_mpi_without_network();
  require(PetscInitializeNoArguments());
  const MPI_Comm alone = PETSC_COMM_SELF;
  const Network& network = model.network;
  std::vector<int> owner(network.nodes(), 0);
  for (int n = 0; n < network.nodes(); ++n)
    if (conditions.fixed[3 * n]) owner[n] = -1;
  const EquationNumbers nodes = number_equations(owner, alone);
  const auto of_equations = [&](const NodalVectors& v) -> Eigen::VectorXd {
    return flat(NodalVectors(v(nodes.own, Eigen::all)));
  };
  const PetscMatrix A = matrix_of(tangent(model, network.X), network, nodes, conditions.fixed, alone);
  set_rigid_motions(A, network.X(nodes.own, Eigen::all), alone);
  const PetscVector f = vector_of(of_equations(conditions.external), 3, alone);
  PetscSolver solver;
  PetscVector u;
  PC preconditioner;
  require(KSPCreate(alone, &solver));
  require(KSPSetOperators(solver, A, A));
  require(KSPSetType(solver, KSPCG));
  require(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED));
  require(KSPSetTolerances(solver, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, 5000));
  require(KSPGetPC(solver, &preconditioner));
  require(PCSetType(preconditioner, PCGAMG));
  require(PCSetFromOptions(preconditioner));
  require(KSPSetFromOptions(solver));
  require(VecDuplicate(f, &u));
  GamgResult result;
  const double start = cpu_seconds();
  require(KSPSetUp(solver));
  const double set_up = cpu_seconds();
  require(KSPSolve(solver, f, u));
  result.setup_seconds = set_up - start;
  result.solve_seconds = cpu_seconds() - set_up;
  KSPConvergedReason reason;
  PetscInt iterations;
  require(KSPGetConvergedReason(solver, &reason));
  require(KSPGetIterationNumber(solver, &iterations));
  result.converged = reason > 0;
  result.iterations = int(iterations);
  const Eigen::VectorXd v = of_equations(other);
  result.difference = (v - values_of(u)).norm() / v.norm();
  return result;
}
#endif

}  // namespace springproof::bench
