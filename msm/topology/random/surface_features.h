// Corners and sharp edges of a body, which its network must represent.
#pragma once

#include "msm/topology/region.h"

namespace springproof {

struct SurfaceFeatures {
  std::vector<Vec3> corners;                   ///< where sharp edges end, meet or turn by more than 30 degrees [m]
  std::vector<std::array<Vec3, 2>> edges;      ///< surface edges with normals more than 30 degrees apart [m]
  std::vector<std::array<Vec3, 3>> triangles;  ///< the whole surface [m]
};

SurfaceFeatures surface_features(const Region& region);

/// Those edges by the numbers of their surface points, each pair and all of them ascending.
std::vector<std::array<int, 2>> sharp_edges(const Region& region);

}  // namespace springproof
