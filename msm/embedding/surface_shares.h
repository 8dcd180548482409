// Shares of a network's nodes in the surface of the body that it fills.
#pragma once

#include "msm/embedding/embedding.h"

namespace springproof {

struct SurfaceShares {
  std::map<std::string, PatchShares> patches;  ///< of the region
  NodalVectors area;  ///< A_n of the whole surface [m^2]: sum A_n = 0, sum A_n x_n^T = V 1 (Gauss's theorem)
};

/// Integrals over the surface, each point of which belongs to the surface nodes nearby: by moving least squares with
/// linear fields in the tangent plane, over nodes that are connected by springs with the nearest (not across a gap in
/// the body).  Fields that are linear in a plane face are integrated exactly there.  On curved surfaces the sums of A_n
/// are made exact by a linear field in proportion to |A_n|.
///
/// Interpolation by linear fields overestimates the integral of a quadratic field f over a face by m times that of its
/// Laplacian, m = h^2 / 12 on squares of edge h, and the second moments of a section carry over to the springs: those
/// of a bar of eight spacings are 2.5 % too large.  By Gauss's theorem that is m times the integral of the normal
/// derivative along the border of the face.  So at sharp edges between plane faces both give m ds of area times length
/// to the inside: nodes of the edge lose what the surface one spacing inwards gains (Gregory's end correction).
/// @throws std::invalid_argument naming a place of the surface that has no node nearby.
SurfaceShares surface_shares(const Region& region, const Network& network);

/// Those of a network whose nodes are the vertices of a body's tetrahedra: of linear fields on the facets, then as
/// above at the sharp edges, but for those of faces too narrow to have nodes a spacing inwards.
SurfaceShares vertex_shares(const Mesh& tetrahedra, const Network& network);

/// Those that springs connect with each node of a network.
std::vector<std::vector<int>> neighbours_of(const Network& network);

/// Those of `nodes` (ascending) that are connected with a node through springs among them, that node first.
std::vector<int> connected_with(int node, const std::vector<int>& nodes,
                                const std::vector<std::vector<int>>& neighbours);

}  // namespace springproof
