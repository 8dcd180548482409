#include "fem_reference/solvers/multigrid.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <fmt/format.h>

namespace springproof::fem {
namespace {

// A PETSc view of the locally owned entries, without a copy.
OwnedVec view(const DofVector& v) {
  OwnedVec vector;
  succeed(VecCreateMPIWithArray(v.get_mpi_communicator(), 1, PetscInt(v.locally_owned_size()), PetscInt(v.size()),
                                v.begin(), &vector));
  return vector;
}

void set_rigid_motions(Mat matrix, const dealii::Mapping<3>& mapping, const dealii::DoFHandler<3>& dof_handler) {
  std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
  dealii::DoFTools::map_dofs_to_support_points(mapping, dof_handler, points);
  OwnedVec coordinates;
  Owned<MatNullSpace, MatNullSpaceDestroy> motions;
  succeed(MatCreateVecs(matrix, &coordinates, nullptr));
  succeed(VecSetBlockSize(coordinates, 3));
  PetscInt first = 0, end = 0;
  succeed(VecGetOwnershipRange(coordinates, &first, &end));
  for (PetscInt i = first; i < end; ++i) succeed(VecSetValue(coordinates, i, points.at(i)[i % 3], INSERT_VALUES));
  succeed(VecAssemblyBegin(coordinates));
  succeed(VecAssemblyEnd(coordinates));
  succeed(MatNullSpaceCreateRigidBody(coordinates, &motions));
  succeed(MatSetNearNullSpace(matrix, motions));
}

MPI_Comm communicator(Mat matrix) { return PetscObjectComm(reinterpret_cast<PetscObject>(matrix)); }

void use_factors(PC preconditioner, Mat matrix) {
  succeed(MatSetOption(matrix, MAT_SPD, PETSC_TRUE));
  succeed(PCSetType(preconditioner, PCCHOLESKY));
  succeed(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
}

void use_gamg(PC preconditioner, Mat matrix, const dealii::Mapping<3>& mapping,
              const dealii::DoFHandler<3>& dof_handler) {
  succeed(MatSetBlockSize(matrix, 3));
  succeed(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
  set_rigid_motions(matrix, mapping, dof_handler);
  succeed(PCSetType(preconditioner, PCGAMG));
  succeed(PCSetFromOptions(preconditioner));
}

/// Cholesky factors for a matrix with at most `most_factored` rows, GAMG for larger ones.  Returns the name of the
/// method.
std::string use_one_of(PC preconditioner, PetscInt most_factored, Mat matrix, const dealii::Mapping<3>& mapping,
                       const dealii::DoFHandler<3>& dof_handler) {
  PetscInt rows = 0;
  succeed(MatGetSize(matrix, &rows, nullptr));
  if (rows <= most_factored) {
    use_factors(preconditioner, matrix);
    return "Cholesky";
  }
  use_gamg(preconditioner, matrix, mapping, dof_handler);
  return "algebraic multigrid";
}

/// Makes the preconditioner of `fine` a cycle of two levels.  Returns that of the linear one.
PC set_levels(PC preconditioner, Mat fine, const LinearLevel& linear) {
  succeed(PCSetType(preconditioner, PCMG));
  succeed(PCMGSetLevels(preconditioner, 2, nullptr));
  succeed(PCMGSetInterpolation(preconditioner, 1, linear.interpolation.petsc()));
  KSP coarse = nullptr, smoother = nullptr;
  succeed(PCMGGetCoarseSolve(preconditioner, &coarse));
  succeed(KSPSetOperators(coarse, linear.matrix.petsc(), linear.matrix.petsc()));
  succeed(KSPSetType(coarse, KSPPREONLY));
  succeed(PCMGGetSmoother(preconditioner, 1, &smoother));
  succeed(KSPSetOperators(smoother, fine, fine));
  succeed(KSPSetType(smoother, KSPCHEBYSHEV));
  succeed(KSPSetNormType(smoother, KSP_NORM_NONE));
  succeed(KSPSetTolerances(smoother, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, 4));
  // Slivers cause a few eigenvalues far above the rest: the usual ten steps of the estimate miss them, and a cycle that
  // amplifies them is not positive definite.
  KSP estimate = nullptr;
  succeed(KSPChebyshevEstEigSet(smoother, 0, 0.1, 0, 1.1));
  succeed(KSPChebyshevEstEigGetKSP(smoother, &estimate));
  succeed(KSPSetTolerances(estimate, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, 50));
  PC jacobi = nullptr, below = nullptr;
  succeed(KSPGetPC(smoother, &jacobi));
  succeed(PCSetType(jacobi, PCJACOBI));
  succeed(KSPGetPC(coarse, &below));
  return below;
}

}  // namespace

SparseMatrix::SparseMatrix(const dealii::IndexSet& rows, const dealii::IndexSet& columns,
                           const dealii::DynamicSparsityPattern& pattern, MPI_Comm comm) {
  const auto first = dealii::types::global_dof_index(rows.n_elements() ? rows.nth_index_in_set(0) : 0);
  std::vector<PetscInt> starts = {0}, indices;
  for (dealii::types::global_dof_index r = first; r < first + rows.n_elements(); ++r) {
    for (auto entry = pattern.begin(r); entry != pattern.end(r); ++entry) indices.push_back(PetscInt(entry->column()));
    starts.push_back(PetscInt(indices.size()));
  }
  succeed(MatCreate(comm, &matrix_));
  succeed(MatSetSizes(matrix_, PetscInt(rows.n_elements()), PetscInt(columns.n_elements()), PetscInt(rows.size()),
                      PetscInt(columns.size())));
  succeed(MatSetType(matrix_, MATAIJ));
  succeed(MatSeqAIJSetPreallocationCSR(matrix_, starts.data(), indices.data(), nullptr));
  succeed(MatMPIAIJSetPreallocationCSR(matrix_, starts.data(), indices.data(), nullptr));
}

void SparseMatrix::clear() { succeed(MatZeroEntries(matrix_)); }

void SparseMatrix::add(const std::vector<PetscInt>& rows, const std::vector<PetscInt>& columns, const double* values) {
  succeed(MatSetValues(matrix_, PetscInt(rows.size()), rows.data(), PetscInt(columns.size()), columns.data(), values,
                       ADD_VALUES));
}

void SparseMatrix::insert(const std::vector<PetscInt>& rows, const std::vector<PetscInt>& columns,
                          const double* values) {
  succeed(MatSetValues(matrix_, PetscInt(rows.size()), rows.data(), PetscInt(columns.size()), columns.data(), values,
                       INSERT_VALUES));
}

void SparseMatrix::finish() {
  succeed(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));
  succeed(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
}

void SparseMatrix::multiply(DofVector& y, const DofVector& x) const { succeed(MatMult(matrix_, view(x), view(y))); }

void SparseMatrix::multiply_transposed_and_add(DofVector& y, const DofVector& x) const {
  const OwnedVec to = view(y);
  succeed(MatMultTransposeAdd(matrix_, view(x), to, to));
}

Multigrid::Multigrid(const SparseMatrix& matrix, const LinearLevel* linear, const dealii::Mapping<3>& mapping,
                     const dealii::DoFHandler<3>& dof_handler, int most_factored) {
  succeed(PCCreate(communicator(matrix.petsc()), &preconditioner_));
  succeed(PCSetOperators(preconditioner_, matrix.petsc(), matrix.petsc()));
  const PC solved = linear ? set_levels(preconditioner_, matrix.petsc(), *linear) : preconditioner_;
  name_ = (linear ? "linear elements by " : "") +
          use_one_of(solved, most_factored, (linear ? linear->matrix : matrix).petsc(), mapping, dof_handler);
  succeed(PCSetUp(preconditioner_));
}

void Multigrid::vmult(DofVector& y, const DofVector& x) const { succeed(PCApply(preconditioner_, view(x), view(y))); }

}  // namespace springproof::fem
