// Embedding of a body's mesh in a network: interpolation to the mesh's nodes, and the network nodes held by each patch.
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
  /// displacements are reproduced exactly, so that the transpose preserves the resultant and moment of loads.
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights;
  std::map<std::string, std::vector<int>> held;  ///< patch -> the network nodes that its supports hold, ascending
};

/// Embedding in a network whose nodes are the mesh's nodes, in their order.
Embedding nodes_of_mesh(const Mesh& mesh);

/// Embedding in any other: moving least squares with linear fields over the nearest network nodes that are connected by
/// springs with the nearest of them (not across a gap in the body), and each patch holds the nodes within `grip` [m] of
/// it (possibly none).  If the network fills `region`, which the mesh only approximates, patches are those of `region`.
/// @throws std::invalid_argument if the nodes span no volume (no area, for a network in a plane z = const).
Embedding embed(const Mesh& mesh, const Network& network, double grip, const Region* region = nullptr);

/// nodes_of_mesh() if there is a node of the network at each node of the mesh and no other, in any order; else embed().
Embedding embed_at_nodes(const Mesh& mesh, const Network& network, double grip, const Region* region = nullptr);

}  // namespace springproof
