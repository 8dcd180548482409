#include "msm/parallel/parted_equations.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace springproof {
namespace {

constexpr const char* solver_options =
    "-displacement_pc_type gamg -displacement_pc_gamg_threshold 0.01 "
    "-displacement_mg_levels_ksp_type chebyshev -displacement_mg_levels_pc_type jacobi "
    "-displacement_mg_levels_ksp_max_it 2 "
    "-mixed_fieldsplit_u_ksp_type preonly -mixed_fieldsplit_u_pc_type gamg -mixed_fieldsplit_u_pc_gamg_threshold 0.01 "
    "-mixed_fieldsplit_u_mg_levels_ksp_type chebyshev -mixed_fieldsplit_u_mg_levels_pc_type jacobi "
    "-mixed_fieldsplit_u_mg_levels_ksp_max_it 2 "
    "-mixed_fieldsplit_p_ksp_type preonly -mixed_fieldsplit_p_pc_type jacobi "
    "-lattice_mg_levels_ksp_type chebyshev -lattice_mg_levels_ksp_max_it 1 "
    "-mixed_lattice_mg_levels_ksp_type richardson -mixed_lattice_mg_levels_ksp_max_it 2 "
    "-anchored_ksp_type preonly -anchored_pc_type lu -anchored_pc_factor_shift_type nonzero -mat_inode_limit 3";

/// Blocks of a tangent row by row: those between coupled nodes, and those of the dispersion's flow.
class TangentRows {
 public:
  TangentRows(const Tangent& K, const Network& network)
      : K_(K), coupled_(coupled_through(carriers_of(network.nodes(), network.cells.carried), coupled_nodes(network))) {
    if (K.dispersive()) flow_ = NodalForms(K.outflow.transpose()) * K.inflow;
  }

  template <class Act>
  void for_each_block(int node, Act act) const {
    for (const int other : coupled_[node]) act(other, K_.local.at(node, other));
    if (flow_.rows() == 0) return;
    for (NodalForms::InnerIterator e(flow_, 3 * node); e; ++e)
      if (e.col() % 3 == 0) {
        const int other = static_cast<int>(e.col() / 3);
        Blocks block;
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) block(a, b) = flow_.coeff(3 * node + a, 3 * other + b);
        act(other, block);
      }
  }

 private:
  const Tangent& K_;
  std::vector<std::vector<int>> coupled_;
  NodalForms flow_;
};

bool is_own(const EquationNumbers& equations, int number) {
  return number >= equations.first && number < equations.first + static_cast<int>(equations.own.size());
}

}  // namespace

EquationNumbers number_equations(const std::vector<int>& owner, MPI_Comm communicator) {
  std::vector<int> all(owner.size());
  std::iota(all.begin(), all.end(), 0);
  return number_equations(owner, all, communicator);
}

EquationNumbers number_equations(const std::vector<int>& owner, const std::vector<int>& of_part,
                                 MPI_Comm communicator) {
  const int rank = rank_of(communicator), processes = size_of(communicator);
  std::vector<int> next(processes + 1), number(owner.size(), -1);
  for (const int o : owner)
    if (o >= 0) ++next[o + 1];
  for (int p = 0; p < processes; ++p) next[p + 1] += next[p];
  EquationNumbers equations;
  equations.first = next[rank];
  for (std::size_t n = 0; n < owner.size(); ++n)
    if (owner[n] >= 0) number[n] = next[owner[n]]++;
  for (std::size_t i = 0; i < of_part.size(); ++i) {
    equations.number.push_back(number[of_part[i]]);
    if (owner[of_part[i]] == rank) equations.own.push_back(static_cast<int>(i));
  }
  return equations;
}

PetscMatrix matrix_of(const Tangent& K, const Network& network, const EquationNumbers& nodes,
                      const std::vector<char>& fixed, MPI_Comm communicator) {
  const TangentRows rows(K, network);
  const auto size = static_cast<PetscInt>(3 * nodes.own.size());
  std::vector<PetscInt> in_own(size), in_others(size);  // entries of each row
  for (std::size_t i = 0; i < nodes.own.size(); ++i)
    rows.for_each_block(nodes.own[i], [&](int other, const Blocks&) {
      if (nodes.number[other] < 0) return;
      for (int d = 0; d < 3; ++d) (is_own(nodes, nodes.number[other]) ? in_own : in_others)[3 * i + d] += 3;
    });
  PetscMatrix A;
  require(MatCreate(communicator, &A));
  require(MatSetSizes(A, size, size, PETSC_DETERMINE, PETSC_DETERMINE));
  require(MatSetType(A, MATAIJ));
  require(MatSetBlockSize(A, 3));
  require(MatSeqAIJSetPreallocation(A, 0, in_own.data()));
  require(MatMPIAIJSetPreallocation(A, 0, in_own.data(), 0, in_others.data()));
  for (const int node : nodes.own)
    rows.for_each_block(node, [&](int other, Blocks block) {
      const PetscInt row = nodes.number[node], column = nodes.number[other];
      if (column < 0) return;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          if ((fixed[3 * node + a] || fixed[3 * other + b]) && !(node == other && a == b)) block(a, b) = 0;
      require(MatSetValuesBlocked(A, 1, &row, 1, &column, block.data(), ADD_VALUES));
    });
  require(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  require(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  require(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  return A;
}

PetscMatrix matrix_of(const NodalForms& B, double unit, const EquationNumbers& pressures, const EquationNumbers& nodes,
                      const std::vector<char>& fixed, MPI_Comm communicator) {
  MatrixRows rows;
  for (const int pressure : pressures.own) {
    std::vector<std::pair<PetscInt, double>> row;
    for (NodalForms::InnerIterator e(B, pressure); e; ++e)
      if (const int node = nodes.number[e.col() / 3]; node >= 0 && !fixed[e.col()])
        row.emplace_back(3 * node + static_cast<int>(e.col() % 3), unit * e.value());
    rows.add(std::move(row));
  }
  return rows.matrix(3 * nodes.own.size(), 1, communicator);
}

PetscMatrix diagonal_matrix(const Eigen::VectorXd& values, const EquationNumbers& equations, MPI_Comm communicator) {
  MatrixRows rows;
  for (int i = 0; i < values.size(); ++i) rows.add({{equations.first + i, values[i]}});
  return rows.matrix(equations.own.size(), 1, communicator);
}

void set_rigid_motions(Mat A, const NodalVectors& own_positions, MPI_Comm communicator) {
  const Eigen::VectorXd flat = Eigen::Map<const Eigen::VectorXd>(own_positions.data(), own_positions.size());
  PetscKernel rigid;
  require(MatNullSpaceCreateRigidBody(vector_of(flat, 3, communicator), &rigid));
  require(MatSetNearNullSpace(A, rigid));
}

PetscVector vector_of(const Eigen::VectorXd& own, int block, MPI_Comm communicator) {
  PetscVector v;
  require(VecCreate(communicator, &v));
  require(VecSetSizes(v, static_cast<PetscInt>(own.size()), PETSC_DETERMINE));
  require(VecSetBlockSize(v, block));
  require(VecSetType(v, VECSTANDARD));
  PetscScalar* data;
  require(VecGetArray(v, &data));
  std::copy(own.begin(), own.end(), data);
  require(VecRestoreArray(v, &data));
  return v;
}

Eigen::VectorXd values_of(Vec v) {
  PetscInt size;
  const PetscScalar* data;
  require(VecGetLocalSize(v, &size));
  require(VecGetArrayRead(v, &data));
  Eigen::VectorXd own = Eigen::Map<const Eigen::VectorXd>(data, size);
  require(VecRestoreArrayRead(v, &data));
  return own;
}

PetscOutcome solve(KSP solver, Mat A, Vec b, Vec x, double tolerance, int max_iterations) {
  constexpr int attempts = 3;
  PetscReal size, residual = 0;
  PetscVector r;
  require(VecNorm(b, NORM_2, &size));
  if (size == 0) return {true, 0, 0};
  require(VecDuplicate(b, &r));
  PetscOutcome outcome{false, 0, 1};
  for (int attempt = 0; attempt < attempts && !outcome.converged; ++attempt) {
    require(KSPSetTolerances(solver, 1e-50, tolerance * size, PETSC_DEFAULT, max_iterations - outcome.iterations));
    require(KSPSetInitialGuessNonzero(solver, attempt > 0 ? PETSC_TRUE : PETSC_FALSE));
    require(KSPSolve(solver, b, x));
    PetscInt iterations;
    KSPConvergedReason reason;
    require(KSPGetIterationNumber(solver, &iterations));
    require(KSPGetConvergedReason(solver, &reason));
    require(MatMult(A, x, r));
    require(VecAYPX(r, -1, b));
    require(VecNorm(r, NORM_2, &residual));
    outcome.iterations += static_cast<int>(iterations);
    outcome.residual = residual / size;
    outcome.converged = outcome.residual <= 1.01 * tolerance;
    if (reason < 0) break;
  }
  return outcome;
}

namespace {

PetscSolver krylov_solver(Mat A, const char* prefix, KSPType type, MPI_Comm communicator) {
  PetscSolver solver;
  require(KSPCreate(communicator, &solver));
  require(KSPSetOptionsPrefix(solver, prefix));
  require(KSPSetOperators(solver, A, A));
  require(KSPSetType(solver, type));
  require(KSPGMRESSetRestart(solver, 60));
  require(KSPSetPCSide(solver, std::strcmp(type, KSPGMRES) == 0 ? PC_RIGHT : PC_LEFT));
  require(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED));
  return solver;
}

}  // namespace

PetscSolver displacement_solver(Mat A, const LatticeTransfers& transfers, MPI_Comm communicator) {
  const bool of_lattice = !transfers.displacements.empty();
  PetscSolver solver = krylov_solver(A, of_lattice ? "lattice_" : "displacement_", KSPCG, communicator);
  if (of_lattice) set_lattice_multigrid(solver, A, transfers, communicator);
  require(KSPSetFromOptions(solver));
  return solver;
}

PetscSolver mixed_solver(Mat system, Mat schur, const LatticeTransfers& transfers, MPI_Comm communicator) {
  if (!transfers.displacements.empty()) {
    PetscSolver solver = krylov_solver(system, "mixed_lattice_", KSPGMRES, communicator);
    set_mixed_lattice_multigrid(solver, system, transfers, communicator);
    require(KSPSetFromOptions(solver));
    return solver;
  }
  PetscSolver solver = krylov_solver(system, "mixed_", KSPGMRES, communicator);
  PC preconditioner;
  IS fields[2];
  require(MatNestGetISs(system, fields, nullptr));
  require(KSPGetPC(solver, &preconditioner));
  require(PCSetType(preconditioner, PCFIELDSPLIT));
  require(PCFieldSplitSetIS(preconditioner, "u", fields[0]));
  require(PCFieldSplitSetIS(preconditioner, "p", fields[1]));
  require(PCFieldSplitSetType(preconditioner, PC_COMPOSITE_SCHUR));
  require(PCFieldSplitSetSchurFactType(preconditioner, PC_FIELDSPLIT_SCHUR_FACT_UPPER));
  require(PCFieldSplitSetSchurPre(preconditioner, PC_FIELDSPLIT_SCHUR_PRE_USER, schur));
  require(KSPSetFromOptions(solver));
  return solver;
}

void set_solver_options() {
  require(PetscOptionsInsertString(nullptr, solver_options));
  if (const char* chosen = std::getenv("PETSC_OPTIONS")) require(PetscOptionsInsertString(nullptr, chosen));
}

}  // namespace springproof
