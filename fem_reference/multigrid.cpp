#include "fem_reference/multigrid.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <fmt/format.h>

#include <stdexcept>

namespace springproof::fem {
namespace {

void check(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw std::runtime_error(fmt::format("PETSc: {}", text ? text : "unknown error"));
}

// A PETSc view of the locally owned entries, without a copy.
class Wrapped {
 public:
  explicit Wrapped(const DofVector& v) {
    check(VecCreateMPIWithArray(v.get_mpi_communicator(), 1, PetscInt(v.locally_owned_size()), PetscInt(v.size()),
                                v.begin(), &vector_));
  }
  ~Wrapped() { VecDestroy(&vector_); }
  Wrapped(const Wrapped&) = delete;
  Wrapped& operator=(const Wrapped&) = delete;
  operator Vec() const { return vector_; }

 private:
  Vec vector_ = nullptr;
};

void set_rigid_motions(Mat matrix, const dealii::Mapping<3>& mapping, const dealii::DoFHandler<3>& dof_handler) {
  std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
  dealii::DoFTools::map_dofs_to_support_points(mapping, dof_handler, points);
  Vec coordinates = nullptr;
  check(MatCreateVecs(matrix, &coordinates, nullptr));
  check(VecSetBlockSize(coordinates, 3));
  PetscInt first = 0, end = 0;
  check(VecGetOwnershipRange(coordinates, &first, &end));
  for (PetscInt i = first; i < end; ++i) check(VecSetValue(coordinates, i, points.at(i)[i % 3], INSERT_VALUES));
  check(VecAssemblyBegin(coordinates));
  check(VecAssemblyEnd(coordinates));
  MatNullSpace motions = nullptr;
  check(MatNullSpaceCreateRigidBody(coordinates, &motions));
  check(MatSetNearNullSpace(matrix, motions));
  check(MatNullSpaceDestroy(&motions));
  check(VecDestroy(&coordinates));
}

MPI_Comm communicator(Mat matrix) { return PetscObjectComm(reinterpret_cast<PetscObject>(matrix)); }

void use_factors(PC preconditioner, Mat matrix) {
  check(MatSetOption(matrix, MAT_SPD, PETSC_TRUE));
  check(PCSetType(preconditioner, PCCHOLESKY));
  check(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
}

void use_gamg(PC preconditioner, Mat matrix, const dealii::Mapping<3>& mapping,
              const dealii::DoFHandler<3>& dof_handler) {
  check(MatSetBlockSize(matrix, 3));
  check(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
  set_rigid_motions(matrix, mapping, dof_handler);
  check(PCSetType(preconditioner, PCGAMG));
  check(PCSetFromOptions(preconditioner));
}

/// Cholesky factors for a matrix with at most `most_factored` rows, GAMG for larger ones.  Returns the name of the
/// method.
std::string use_one_of(PC preconditioner, PetscInt most_factored, Mat matrix, const dealii::Mapping<3>& mapping,
                       const dealii::DoFHandler<3>& dof_handler) {
  PetscInt rows = 0;
  check(MatGetSize(matrix, &rows, nullptr));
  if (rows <= most_factored) {
    use_factors(preconditioner, matrix);
    return "Cholesky";
  }
  use_gamg(preconditioner, matrix, mapping, dof_handler);
  return "algebraic multigrid";
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
  check(MatCreate(comm, &matrix_));
  check(MatSetSizes(matrix_, PetscInt(rows.n_elements()), PetscInt(columns.n_elements()), PetscInt(rows.size()),
                    PetscInt(columns.size())));
  check(MatSetType(matrix_, MATAIJ));
  check(MatSeqAIJSetPreallocationCSR(matrix_, starts.data(), indices.data(), nullptr));
  check(MatMPIAIJSetPreallocationCSR(matrix_, starts.data(), indices.data(), nullptr));
}

SparseMatrix::~SparseMatrix() { MatDestroy(&matrix_); }

void SparseMatrix::clear() { check(MatZeroEntries(matrix_)); }

void SparseMatrix::add(const std::vector<PetscInt>& rows, const std::vector<PetscInt>& columns, const double* values) {
  check(MatSetValues(matrix_, PetscInt(rows.size()), rows.data(), PetscInt(columns.size()), columns.data(), values,
                     ADD_VALUES));
}

void SparseMatrix::insert(const std::vector<PetscInt>& rows, const std::vector<PetscInt>& columns,
                          const double* values) {
  check(MatSetValues(matrix_, PetscInt(rows.size()), rows.data(), PetscInt(columns.size()), columns.data(), values,
                     INSERT_VALUES));
}

void SparseMatrix::finish() {
  check(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
}

void SparseMatrix::multiply(DofVector& y, const DofVector& x) const { check(MatMult(matrix_, Wrapped(x), Wrapped(y))); }

void SparseMatrix::multiply_transposed_and_add(DofVector& y, const DofVector& x) const {
  const Wrapped to(y);
  check(MatMultTransposeAdd(matrix_, Wrapped(x), to, to));
}

Multigrid::Multigrid(const SparseMatrix& matrix, const dealii::Mapping<3>& mapping,
                     const dealii::DoFHandler<3>& dof_handler, int most_factored) {
  check(PCCreate(communicator(matrix.petsc()), &preconditioner_));
  check(PCSetOperators(preconditioner_, matrix.petsc(), matrix.petsc()));
  name_ = use_one_of(preconditioner_, most_factored, matrix.petsc(), mapping, dof_handler);
  check(PCSetUp(preconditioner_));
}

Multigrid::Multigrid(const SparseMatrix& matrix, const dealii::Mapping<3>& mapping, const LinearLevel& linear,
                     int most_factored) {
  check(PCCreate(communicator(matrix.petsc()), &preconditioner_));
  check(PCSetOperators(preconditioner_, matrix.petsc(), matrix.petsc()));
  check(PCSetType(preconditioner_, PCMG));
  check(PCMGSetLevels(preconditioner_, 2, nullptr));
  check(PCMGSetInterpolation(preconditioner_, 1, linear.interpolation.petsc()));
  KSP coarse = nullptr, smoother = nullptr;
  check(PCMGGetCoarseSolve(preconditioner_, &coarse));
  check(KSPSetOperators(coarse, linear.matrix.petsc(), linear.matrix.petsc()));
  check(KSPSetType(coarse, KSPPREONLY));
  PC below = nullptr;
  check(KSPGetPC(coarse, &below));
  name_ = "linear elements by " + use_one_of(below, most_factored, linear.matrix.petsc(), mapping, linear.dof_handler);
  check(PCMGGetSmoother(preconditioner_, 1, &smoother));
  check(KSPSetOperators(smoother, matrix.petsc(), matrix.petsc()));
  check(KSPSetType(smoother, KSPCHEBYSHEV));
  check(KSPSetNormType(smoother, KSP_NORM_NONE));
  check(KSPSetTolerances(smoother, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, 4));
  // Slivers cause a few eigenvalues far above the rest: the usual ten steps of the estimate miss them, and a cycle that
  // amplifies them is not positive definite.
  KSP estimate = nullptr;
  check(KSPChebyshevEstEigSet(smoother, 0, 0.1, 0, 1.1));
  check(KSPChebyshevEstEigGetKSP(smoother, &estimate));
  check(KSPSetTolerances(estimate, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, 50));
  PC jacobi = nullptr;
  check(KSPGetPC(smoother, &jacobi));
  check(PCSetType(jacobi, PCJACOBI));
  check(PCSetUp(preconditioner_));
}

Multigrid::~Multigrid() { PCDestroy(&preconditioner_); }

void Multigrid::vmult(DofVector& y, const DofVector& x) const {
  check(PCApply(preconditioner_, Wrapped(x), Wrapped(y)));
}

}  // namespace springproof::fem
