// Mends of a surface that leave the body as it is.
#pragma once

#include <optional>
#include <vector>

#include "meshes/surface/surface_topology.h"

namespace springproof {

struct Welded {
  Surface surface;                 ///< every point used
  std::vector<Vec3> without_area;  ///< a point of each facet left out because two of its corners became one
  std::vector<Vec3> twice;         ///< a point of each facet left out because another has the same corners
};

/// Makes points up to `tolerance` apart one, the first of them.
Welded weld(const Surface& raw, double tolerance);

/// Turns facets until neighbours agree, in every shell the fewer; gives those turned.  Nothing if the surface has only
/// one side.
std::optional<std::vector<int>> orient(Surface& surface, const std::vector<Side>& sides, const Neighbours& neighbours);

void turn_inside_out(Surface& surface);

struct Flattened {
  std::vector<Vec3> removed;  ///< a point of each facet that was lower than `height`
  std::vector<Vec3> left;     ///< of each that still is
};

/// Takes away facets lower than `height` above their longest edge: the edge is drawn to their third corner, which lies
/// on it. The surface is closed and oriented; `neighbours` is kept.
Flattened remove_flat_facets(Surface& surface, Neighbours& neighbours, double height);

}  // namespace springproof
