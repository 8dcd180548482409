// Order of the nodes and springs of a network for the list kernels.
#pragma once

#include <array>
#include <vector>

#include "msm/kernels/block_forces.h"

namespace springproof {

/// The axes of a body, the longest first.
std::array<int, 3> axes_by_extent(const NodalVectors& X);

/// Nodes are ordered in layers across the longest axis of the body and in strips of a layer, so that neighbours are
/// close in memory and a sweep completes a layer two layers later; springs are in blocks of four that share their first
/// node. Which end of a spring comes first is chosen such that nearly all blocks are full.
struct SpringBlocks {
  std::vector<int> order;   ///< node of the network at each place
  std::vector<int> i, j;    ///< places: i per block, j per entry (four a block)
  std::vector<int> spring;  ///< per entry the network's spring; -1: unused lane

  explicit SpringBlocks(const Network& network);

  static constexpr long blocks_of_piece = 256;  ///< some 150 nodes

  int nodes() const { return static_cast<int>(order.size()); }
  BlockPlan plan() const;
  std::size_t entries() const { return j.size(); }
  ListPattern pattern() const { return pattern(0, static_cast<long>(i.size())); }
  ListPattern pattern(long begin, long end) const {
    return {end - begin, i.data() + begin, j.data() + 4 * begin};
  }  ///< blocks begin <= b < end only

  /// 0 if the spring of an entry has its node i first in the block, else 1.
  int end_of_i(const Network& network, std::size_t e) const {
    return network.springs[spring[e]].i == order[i[e / 4]] ? 0 : 1;
  }

  /// value(spring) per entry; 0 in unused lanes.
  template <class Real, class Value>
  std::vector<Real> per_entry(Value value) const {
    std::vector<Real> values(entries());
    for (std::size_t e = 0; e < values.size(); ++e)
      if (spring[e] >= 0) values[e] = static_cast<Real>(value(spring[e]));
    return values;
  }
};

}  // namespace springproof
