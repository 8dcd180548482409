// Order of the cells and nodes of a network for the kernels of lists of cells.
#pragma once

#include <vector>

#include "msm/kernels/block_forces.h"

namespace springproof {

/// Cells row by row and layer by layer across the longest axis of the body, in blocks; nodes in the order in which the
/// last of their cells comes, so that a sweep completes them in their order, a layer later.  Anchors and bonds are in
/// blocks too.  The cells of a block are of one material, those of a layer one material after the other.
struct CellOrder {
  std::vector<int> cells;         ///< of the network; -1: the rest of a block
  std::vector<int> material;      ///< of the cells of each block
  std::vector<int> anchors;       ///< of the network
  std::vector<int> first_anchor;  ///< per block, and one more
  std::vector<int> bonds;         ///< of the network
  std::vector<int> first_bond;    ///< per block, and one more
  std::vector<int> place;         ///< of each node
  BlockPlan plan;

  /// @param network with cells
  /// @param cells_of_block how many a kernel computes together
  CellOrder(const Network& network, int cells_of_block);
};

}  // namespace springproof
