// PETSc multigrid for elasticity, and PETSc matrices that multiply deal.II's vectors.
#pragma once

#include <deal.II/base/index_set.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <petscksp.h>

#include <string>
#include <vector>

#include "fem_reference/solvers/petsc.h"
#include "fem_reference/system/elastic_system.h"

namespace springproof::fem {

/// A sparse matrix assembled from cell matrices, distributed over the processes of `comm`.
class SparseMatrix {
 public:
  /// `pattern` contains the locally owned rows.
  SparseMatrix(const dealii::IndexSet& rows, const dealii::IndexSet& columns,
               const dealii::DynamicSparsityPattern& pattern, MPI_Comm comm);

  void clear();
  /// `values` in row-major order.
  void add(const std::vector<PetscInt>& rows, const std::vector<PetscInt>& columns, const double* values);
  void insert(const std::vector<PetscInt>& rows, const std::vector<PetscInt>& columns, const double* values);
  void finish();  ///< after the last add() or insert()

  void multiply(DofVector& y, const DofVector& x) const;                     ///< y = A x
  void multiply_transposed_and_add(DofVector& y, const DofVector& x) const;  ///< y += A^T x

  Mat petsc() const { return matrix_; }

 private:
  OwnedMat matrix_;
};

/// Stiffness of linear elements on the same cells.
struct LinearLevel {
  const SparseMatrix& matrix;
  const SparseMatrix& interpolation;  ///< from the linear to the quadratic elements
};

/// One V-cycle: GAMG, smoothed aggregation with the rigid-body modes as near null space, or Cholesky factors of a small
/// matrix; for quadratic elements applied to a coarse level of linear ones, which makes the set-up several times
/// cheaper.  Symmetric, positive definite if the matrices are.
class Multigrid {
 public:
  /// Rows, of the linear level if there is one, are numbered as the degrees of freedom of the handler, three per node;
  /// the matrices must outlive the preconditioner.  A matrix there with at most `most_factored` rows is factored.
  Multigrid(const SparseMatrix& matrix, const LinearLevel* linear, const dealii::Mapping<3>& mapping,
            const dealii::DoFHandler<3>& dof_handler, int most_factored);

  void vmult(DofVector& y, const DofVector& x) const;
  const std::string& name() const { return name_; }  ///< for the report

 private:
  Owned<PC, PCDestroy> preconditioner_;
  std::string name_;
};

}  // namespace springproof::fem
