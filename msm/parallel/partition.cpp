#include "msm/parallel/partition.h"

#include <algorithm>

#include "msm/algebra/block_matrix.h"
#include "msm/parallel/petsc.h"

namespace springproof {
namespace {

using Partitioning = Owned<MatPartitioning, MatPartitioningDestroy>;

/// This process' rows of the graph of springs and cells; its arrays become PETSc's.
PetscMatrix graph(const Network& network, MPI_Comm communicator) {
  const int rank = rank_of(communicator), processes = size_of(communicator);
  const long nodes = network.nodes();
  const int first = static_cast<int>(nodes * rank / processes), last = static_cast<int>(nodes * (rank + 1) / processes);
  const auto coupled = coupled_through(carriers_of(network.nodes(), network.cells.carried), coupled_nodes(network));
  std::size_t entries = 0;
  for (int n = first; n < last; ++n) entries += coupled[n].size() - 1;
  PetscInt *begin, *columns;
  require(PetscMalloc1(last - first + 1, &begin));
  require(PetscMalloc1(entries, &columns));
  begin[0] = 0;
  for (int n = first; n < last; ++n) {  // each node is coupled with itself too
    const PetscInt* end = std::remove_copy(coupled[n].begin(), coupled[n].end(), columns + begin[n - first], n);
    begin[n - first + 1] = static_cast<PetscInt>(end - columns);
  }
  PetscMatrix adjacency;
  require(
      MatCreateMPIAdj(communicator, last - first, static_cast<PetscInt>(nodes), begin, columns, nullptr, &adjacency));
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
