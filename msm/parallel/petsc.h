// What the users of PETSc and MPI share: its errors as exceptions, its objects with owners, sums over processes.
#pragma once

#include <petscksp.h>

#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "problem/system/owned.h"

namespace springproof {

/// A failure of PETSc, on one process perhaps, which the others wait for: ends the program.
class PetscFailure : public std::exception {
 public:
  explicit PetscFailure(int code) : what_("PETSc failed with code " + std::to_string(code)) {}
  const char* what() const noexcept override { return what_.c_str(); }

 private:
  std::string what_;
};

inline void require(PetscErrorCode code) {
  if (code != 0) throw PetscFailure(static_cast<int>(code));
}

inline int rank_of(MPI_Comm communicator) {
  int rank;
  MPI_Comm_rank(communicator, &rank);
  return rank;
}

inline int size_of(MPI_Comm communicator) {
  int size;
  MPI_Comm_size(communicator, &size);
  return size;
}

using PetscMatrix = Owned<Mat, MatDestroy>;
using PetscVector = Owned<Vec, VecDestroy>;
using PetscSolver = Owned<KSP, KSPDestroy>;
using PetscIndices = Owned<IS, ISDestroy>;
using PetscKernel = Owned<MatNullSpace, MatNullSpaceDestroy>;

/// The rows of a sparse matrix that are this process', one after the other.
class MatrixRows {
 public:
  /// @param entries columns, each once, and values
  void add(std::vector<std::pair<PetscInt, double>> entries);
  /// @param own_columns of this process
  /// @param block size
  PetscMatrix matrix(std::size_t own_columns, int block, MPI_Comm communicator) const;

 private:
  std::vector<PetscInt> begin_ = {0}, columns_;
  std::vector<PetscScalar> values_;
};

/// Sums over all processes.
struct Sum {
  MPI_Comm communicator;
  double operator()(double own) const;
  /// Adds up values of all processes, entry by entry; any number of them.
  void all(double* values, long count) const;
};

/// Runs what a process does for itself; an error of any process is thrown by all, as InputError with the message of
/// one.
void agree(MPI_Comm communicator, const std::function<void()>& step);

}  // namespace springproof
