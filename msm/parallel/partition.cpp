#include "msm/parallel/partition.h"

#include "msm/distribution/model_part.h"
#include "msm/parallel/petsc.h"

namespace springproof {
namespace {

using Partitioning = Owned<MatPartitioning, MatPartitioningDestroy>;

/// This process' rows of the graph of springs and cells; its arrays become PETSc's.
PetscMatrix graph(const Network& network, MPI_Comm communicator) {
  const int rank = rank_of(communicator), processes = size_of(communicator);
  const long n = network.nodes();
  const int first = static_cast<int>(n * rank / processes), last = static_cast<int>(n * (rank + 1) / processes);
  const auto rows = neighbours(network, first, last);
  std::size_t entries = 0;
  for (const auto& row : rows) entries += row.size();
  PetscInt *begin, *columns;
  require(PetscMalloc1(rows.size() + 1, &begin));
  require(PetscMalloc1(entries, &columns));
  begin[0] = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::copy(rows[i].begin(), rows[i].end(), columns + begin[i]);
    begin[i + 1] = begin[i] + static_cast<PetscInt>(rows[i].size());
  }
  PetscMatrix adjacency;
  require(MatCreateMPIAdj(communicator, last - first, static_cast<PetscInt>(n), begin, columns, nullptr, &adjacency));
  return adjacency;
}

}  // namespace

std::vector<int> owners_of_nodes(const Network& network, MPI_Comm communicator) {
  if (size_of(communicator) == 1) return std::vector<int>(network.nodes(), 0);
  const PetscMatrix adjacency = graph(network, communicator);
  Partitioning partitioning;
  PetscIndices own, all;
  require(MatPartitioningCreate(communicator, &partitioning));
  require(MatPartitioningSetAdjacency(partitioning, adjacency));
  require(MatPartitioningSetFromOptions(partitioning));
  require(MatPartitioningApply(partitioning, &own));
  require(ISAllGather(own, &all));
  const PetscInt* owner;
  require(ISGetIndices(all, &owner));
  std::vector<int> owners(owner, owner + network.nodes());
  require(ISRestoreIndices(all, &owner));
  return owners;
}

}  // namespace springproof
