// Which process has which node of a network.
#pragma once

#include <mpi.h>

#include <vector>

#include "msm/topology/network.h"

namespace springproof {

/// A partition of the nodes into one part per process, of about equal numbers of nodes and few springs between parts,
/// by PETSc's partitioner (PT-Scotch, where PETSc has it).
/// @param network the same on every process
/// @param communicator of the processes, all of which call this
/// @return process of each node
std::vector<int> owners_of_nodes(const Network& network, MPI_Comm communicator);

}  // namespace springproof
