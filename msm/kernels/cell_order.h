// Order of the cells and nodes of a network for the kernels of lists of cells.
#pragma once

#include <vector>

#include "msm/kernels/block_forces.h"

namespace springproof {

/// Cells row by row and layer by layer across the longest axis of the body, in blocks; nodes in the order in which the
/// last of their cells comes, so that a sweep completes them in their order, a layer later.  Anchors are in blocks too.
struct CellOrder {
  std::vector<int> cells;         ///< of the network
  std::vector<int> anchors;       ///< of the network
  std::vector<int> first_anchor;  ///< per block, and one more
  std::vector<int> place;         ///< of each node
  BlockPlan plan;

  /// @param network with cells
  /// @param cells_of_block how many a kernel computes together
  CellOrder(const Network& network, int cells_of_block);
};

}  // namespace springproof
