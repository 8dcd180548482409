// Several steps in one sweep through the memory, and on several threads: each follows the one before at a distance.
#pragma once

#include <functional>

#include "msm/kernels/spring_blocks.h"
#include "msm/kernels/workers.h"

namespace springproof {

/// The blocks in pieces, in their order.  A node is complete when all its springs have been computed; a piece of the
/// next step may be computed as soon as all nodes it touches are complete, which is `lag` pieces later.
struct Wavefront {
  std::vector<long> begin;    ///< first block of each piece, and the end
  std::vector<int> complete;  ///< nodes below are complete before the piece; one more: all nodes
  long lag = 1;               ///< pieces; a step has done piece c + lag - 1 before the next does piece c

  explicit Wavefront(const SpringBlocks& blocks);

  long pieces() const { return static_cast<long>(begin.size()) - 1; }
};

/// Computes one piece of one step, its springs first and then the nodes that it completes.  Must not throw.
using PieceOfStep = std::function<void(long step, long piece)>;

/// All pieces of steps 0, 1, ...: one thread takes two steps at a time, so that the second finds in the cache what the
/// first has fetched; several threads take the steps in turn.  The order of the pieces of a step is the same whoever
/// computes them, and so is the result, to the last bit.
void run_steps(const Wavefront& wavefront, long steps, Workers& workers, const PieceOfStep& compute);

}  // namespace springproof
