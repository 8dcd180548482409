// Wavefront scheduling of time steps, in one sweep through memory or on several threads: each step follows the previous
// one at a distance.
#pragma once

#include <functional>

#include "msm/kernels/block_forces.h"
#include "msm/kernels/workers.h"

namespace springproof {

/// Partition of the blocks into pieces, in their order.  A node is complete when all blocks that touch it have been
/// computed; a piece of the next step may be computed as soon as all nodes it touches are complete, which is `lag`
/// pieces later.
struct Wavefront {
  std::vector<long> begin;    ///< first block of each piece, and the end
  std::vector<int> complete;  ///< nodes below are complete before the piece; one more: all nodes
  long lag = 1;               ///< [pieces] a step has computed piece c + lag - 1 before the next computes piece c

  explicit Wavefront(const BlockPlan& plan);

  long pieces() const { return static_cast<long>(begin.size()) - 1; }
};

/// Computes one piece of one step, its blocks first and then the nodes that it completes.  Must not throw.
using PieceOfStep = std::function<void(long step, long piece)>;

/// Computes all pieces of steps 0, 1, ...: one thread computes two steps at a time, so that the second finds in the
/// cache what the first has fetched; several threads take the steps in turn.  The order of the pieces of a step does
/// not depend on the number of threads, and neither does the result, to the last bit.
void run_steps(const Wavefront& wavefront, long steps, Workers& workers, const PieceOfStep& compute);

}  // namespace springproof
