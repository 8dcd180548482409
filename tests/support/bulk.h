// The inside of a body's network.
#pragma once

#include <algorithm>

#include "msm/topology/network.h"
#include "msm/topology/region.h"

namespace springproof::test {

/// Means over the nodes that are deeper in the body than the longest spring: none of their springs is missing.
struct Bulk {
  std::vector<char> marked;
  long nodes = 0;
  double springs_per_node = 0, mean_length = 0, density = 0;

  template <class Depth>
  Bulk(const Network& network, const Depth& depth) {
    double longest = 0, ends = 0, volume = 0;
    for (const Spring& s : network.springs) longest = std::max(longest, s.rest_length);
    for (int n = 0; n < network.nodes(); ++n) {
      marked.push_back(depth(Vec3(network.X.row(n).transpose())) >= longest);
      if (marked[n]) ++nodes, volume += network.volume[n];
    }
    for (const Spring& s : network.springs)
      for (const int end : {s.i, s.j})
        if (marked[end]) ++ends, mean_length += s.rest_length;
    mean_length /= ends;
    springs_per_node = ends / static_cast<double>(nodes);
    density = static_cast<double>(nodes) / volume;
  }
};

/// Of a block.
inline Bulk bulk_of(const Network& network, const Region& block) {
  return {network, [&](const Vec3& x) { return std::min((x - block.lower).minCoeff(), (block.upper - x).minCoeff()); }};
}

}  // namespace springproof::test
