#include "msm/dynamics/wavefront.h"

#include <algorithm>

namespace springproof {
namespace {

constexpr long blocks_of_piece = 256;  // some 150 nodes, a few microseconds

/// Number of pieces that a worker has completed in all its steps; read by the worker of the following step.
struct alignas(64) PiecesDone {
  std::atomic<long> value = 0;
};

/// Last piece that touches each node.
std::vector<long> last_pieces(const SpringBlocks& blocks) {
  std::vector<long> last(blocks.order.size(), 0);
  for (std::size_t e = 0; e < blocks.entries(); ++e) {
    const long piece = static_cast<long>(e / block_springs) / blocks_of_piece;
    last[blocks.i[e / block_springs]] = last[blocks.j[e]] = piece;
  }
  return last;
}

}  // namespace

Wavefront::Wavefront(const SpringBlocks& blocks) : complete{0} {
  const long all = static_cast<long>(blocks.i.size());
  for (long b = 0; b == 0 || b < all; b += blocks_of_piece) begin.push_back(b);  // nodes without springs move as well
  begin.push_back(all);
  const std::vector<long> last = last_pieces(blocks);
  std::vector<long> when(last.size());  // nodes are moved in their order
  std::size_t node = 0;
  for (long piece = 0; piece < pieces(); ++piece) {
    while (node < last.size() && last[node] <= piece) when[node++] = piece;
    complete.push_back(static_cast<int>(node));
  }
  for (std::size_t e = 0; e < blocks.entries(); ++e) {
    const long piece = static_cast<long>(e / block_springs) / blocks_of_piece;
    lag = std::max({lag, when[blocks.i[e / block_springs]] - piece + 1, when[blocks.j[e]] - piece + 1});
  }
}

void run_steps(const Wavefront& wavefront, long steps, Workers& workers, const PieceOfStep& compute) {
  const long count = workers.count(), together = count == 1 ? 2 : 1, pieces = wavefront.pieces(), lag = wavefront.lag;
  std::vector<PiecesDone> done(count);
  const std::function<void(int)> work = [&](int worker) {
    for (long first = worker * together; first < steps; first += count * together)
      for (long position = 0; position < pieces + (together - 1) * lag; ++position)
        for (long step = first; step < std::min(first + together, steps); ++step) {
          const long piece = position - (step - first) * lag;
          if (piece < 0 || piece >= pieces) continue;
          const long before = step - 1;  // the previous step, which must be ahead by `lag` pieces
          if (count > 1 && before >= 0)
            wait_until(done[before % count].value, before / count * pieces + std::min(piece + lag, pieces));
          compute(step, piece);
          done[worker].value.fetch_add(1, std::memory_order_release);
        }
  };
  workers.run(work);
}

}  // namespace springproof
