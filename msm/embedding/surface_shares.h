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
/// @throws std::invalid_argument if a part of the surface has no node.
SurfaceShares surface_shares(const Region& region, const Network& network);

}  // namespace springproof
