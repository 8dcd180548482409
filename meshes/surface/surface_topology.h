// How the facets of a welded surface are connected.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "meshes/surface/surface.h"

namespace springproof {

/// One edge of one facet.
struct Side {
  int low, high;  ///< the points of the edge
  int facet;
  int corner;  ///< the edge runs from this corner of the facet to the next
};

/// All sides, by edge.
std::vector<Side> sides_by_edge(const Surface& surface);

/// Calls `visit(std::span<const Side>)` with the sides of each edge.
template <class Visit>
void for_each_edge(const std::vector<Side>& sides, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    visit(std::span<const Side>(sides.data() + begin, end - begin));
  }
}

/// The facet beyond each side (from corner i to the next), of a surface with two facets at every edge.
using Neighbours = std::vector<std::array<int, 3>>;
Neighbours neighbours_of(const std::vector<Side>& sides, std::size_t facets);

/// Number of the shell (part joined by edges) of each facet, from 0.
std::vector<int> shells(const Neighbours& neighbours);

/// Connected open edges: the rim of a hole.
struct Hole {
  int edges = 0;
  Vec3 start;  ///< one of its points
  Box box;
};
std::vector<Hole> holes(const Surface& surface, const std::vector<Side>& sides);

/// Points where facets meet that are not joined by edges round the point.
std::vector<int> pinched_points(const Surface& surface, const Neighbours& neighbours);

/// How often a closed surface winds round a point: 1 inside, 0 outside.
double winding_number(const Surface& surface, const Vec3& point);

}  // namespace springproof
