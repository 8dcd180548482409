#include "comparisons/bench/gamg.h"

#include <stdexcept>

#include "msm/algebra/tangent.h"
#include "problem/system/mpi_start.h"
#include "problem/system/run_cost.h"

#ifdef SPRINGPROOF_PETSC
#include <petscksp.h>
#endif

namespace springproof::bench {

#ifndef SPRINGPROOF_PETSC
bool has_gamg() { return false; }
GamgResult solve_gamg(const MassSpringModel&, const BoundaryConditions&, double, const NodalVectors&) {
  throw std::runtime_error("this program was built without PETSc");
}
#else
namespace {

void require(PetscErrorCode code) {
  if (code != 0) throw std::runtime_error("PETSc failed with code " + std::to_string(int(code)));
}

/// Number of each free node, -1 for clamped ones.
std::vector<int> free_nodes(const BoundaryConditions& conditions, int nodes, int& free) {
  std::vector<int> number(nodes, -1);
  free = 0;
  for (int n = 0; n < nodes; ++n)
    if (!conditions.fixed[3 * n]) number[n] = free++;
  return number;
}

Mat assemble(const MassSpringModel& model, const std::vector<int>& number, int free) {
  const Tangent K = tangent(model, model.network.X);
  if (K.dispersive()) throw std::runtime_error("GAMG is not set up for momentum dispersion");
  const auto coupled = coupled_nodes(model.network);
  std::vector<PetscInt> entries(3 * std::size_t(free));
  for (int n = 0; n < model.network.nodes(); ++n)
    if (number[n] >= 0)
      for (int c = 0; c < 3; ++c)
        for (const int m : coupled[n]) entries[3 * number[n] + c] += number[m] >= 0 ? 3 : 0;
  Mat A;
  require(MatCreateSeqAIJ(PETSC_COMM_SELF, 3 * free, 3 * free, 0, entries.data(), &A));
  require(MatSetBlockSize(A, 3));
  for (int n = 0; n < model.network.nodes(); ++n)
    for (const int m : coupled[n]) {
      const PetscInt row = number[n], column = number[m];
      if (row >= 0 && column >= 0)
        require(MatSetValuesBlocked(A, 1, &row, 1, &column, K.local.at(n, m).data(), INSERT_VALUES));
    }
  require(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  require(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  require(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  return A;
}

/// The free nodes' rows as a PETSc vector of block size 3.
Vec vector_of(const NodalVectors& values, const std::vector<int>& number, int free) {
  Vec v;
  PetscScalar* data;
  require(VecCreateSeq(PETSC_COMM_SELF, 3 * free, &v));
  require(VecSetBlockSize(v, 3));
  require(VecGetArray(v, &data));
  for (Eigen::Index n = 0; n < values.rows(); ++n)
    if (number[n] >= 0)
      for (int c = 0; c < 3; ++c) data[3 * number[n] + c] = values(n, c);
  require(VecRestoreArray(v, &data));
  return v;
}

double difference(Vec u, const NodalVectors& other, const std::vector<int>& number, int free) {
  Vec v = vector_of(other, number, free);
  PetscReal size, distance;
  require(VecNorm(v, NORM_2, &size));
  require(VecAXPY(v, -1, u));
  require(VecNorm(v, NORM_2, &distance));
  return distance / size;
}

}  // namespace

bool has_gamg() { return true; }

GamgResult solve_gamg(const MassSpringModel& model, const BoundaryConditions& conditions, double tolerance,
                      const NodalVectors& other) {
  start_mpi_without_network();
  require(PetscInitializeNoArguments());
  int free;
  const std::vector<int> number = free_nodes(conditions, model.network.nodes(), free);
  Mat A = assemble(model, number, free);
  const Vec X = vector_of(model.network.X, number, free), f = vector_of(conditions.external, number, free);
  MatNullSpace rigid;
  require(MatNullSpaceCreateRigidBody(X, &rigid));
  require(MatSetNearNullSpace(A, rigid));
  KSP solver;
  PC preconditioner;
  require(KSPCreate(PETSC_COMM_SELF, &solver));
  require(KSPSetOperators(solver, A, A));
  require(KSPSetType(solver, KSPCG));
  require(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED));
  require(KSPSetTolerances(solver, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, 5000));
  require(KSPGetPC(solver, &preconditioner));
  require(PCSetType(preconditioner, PCGAMG));
  require(PCSetFromOptions(preconditioner));
  require(KSPSetFromOptions(solver));
  GamgResult result;
  Vec u;
  require(VecDuplicate(f, &u));
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
  result.difference = difference(u, other, number, free);
  return result;
}
#endif

}  // namespace springproof::bench
