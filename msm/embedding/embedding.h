// How a network carries a body: the mesh moves with the network's nodes, and the patches hold some of them.
#pragma once

#include <Eigen/SparseCore>
#include <map>
#include <string>
#include <vector>

#include "msm/topology/network.h"
#include "msm/topology/region.h"

namespace springproof {

struct Embedding {
  /// Displacement of the mesh's nodes = weights * displacement of the network's, mesh nodes x network nodes.  Affine
  /// displacements are carried exactly, so that transposed they take loads over with their resultant and moment.
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights;
  std::map<std::string, std::vector<int>> held;  ///< patch -> the network nodes that its supports hold, ascending
};

/// Of a network whose nodes are the mesh's nodes, in their order.
Embedding nodes_of_mesh(const Mesh& mesh);

/// Of any other: moving least squares with linear fields over the nearest network nodes that springs join to the
/// nearest of them (not across a gap in the body), and each patch holds the nodes within `grip` [m] of it (none, if
/// there is none so near).  Patches are those of `region` where the network fills that and the mesh is only nearly the
/// body.
/// @throws std::invalid_argument if the nodes span no volume (no area, for a network in a plane z = const).
Embedding embed(const Mesh& mesh, const Network& network, double grip, const Region* region = nullptr);

}  // namespace springproof
