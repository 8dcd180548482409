#include "msm/parallel/petsc.h"

#include <algorithm>

#include "problem/system/input_error.h"

namespace springproof {

void MatrixRows::add(std::vector<std::pair<PetscInt, double>> entries) {
  std::sort(entries.begin(), entries.end());
  for (const auto& [column, value] : entries) {
    columns_.push_back(column);
    values_.push_back(value);
  }
  begin_.push_back(static_cast<PetscInt>(columns_.size()));
}

PetscMatrix MatrixRows::matrix(std::size_t own_columns, int block, MPI_Comm communicator) const {
  PetscMatrix A;
  require(MatCreate(communicator, &A));
  require(MatSetSizes(A, static_cast<PetscInt>(begin_.size() - 1), static_cast<PetscInt>(own_columns), PETSC_DETERMINE,
                      PETSC_DETERMINE));
  require(MatSetType(A, MATAIJ));
  require(MatSetBlockSize(A, block));
  require(MatSeqAIJSetPreallocationCSR(A, begin_.data(), columns_.data(), values_.data()));
  require(MatMPIAIJSetPreallocationCSR(A, begin_.data(), columns_.data(), values_.data()));
  return A;
}

double Sum::operator()(double own) const {
  MPI_Allreduce(MPI_IN_PLACE, &own, 1, MPI_DOUBLE, MPI_SUM, communicator);
  return own;
}

void Sum::all(double* values, long count) const {
  constexpr long most = 1 << 24;
  for (long first = 0; first < count; first += most)
    MPI_Allreduce(MPI_IN_PLACE, values + first, static_cast<int>(std::min(most, count - first)), MPI_DOUBLE, MPI_SUM,
                  communicator);
}

void agree(MPI_Comm communicator, const std::function<void()>& step) {
  std::string message;
  try {
    step();
  } catch (const std::exception& e) {
    message = e.what();
    if (message.empty()) message = "an error without a message";
  }
  const int rank = rank_of(communicator), length = static_cast<int>(message.size());
  struct {
    int length, rank;
  } own{length, rank}, worst;
  MPI_Allreduce(&own, &worst, 1, MPI_2INT, MPI_MAXLOC, communicator);
  if (worst.length == 0) return;
  message.resize(worst.length);
  MPI_Bcast(message.data(), worst.length, MPI_CHAR, worst.rank, communicator);
  throw InputError(message);
}

}  // namespace springproof
