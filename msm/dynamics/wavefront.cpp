#include "msm/dynamics/wavefront.h"

#include <algorithm>

namespace springproof {
namespace {

/// Number of pieces that a worker has completed in all its steps; read by the worker of the following step.
struct alignas(64) PiecesDone {
  std::atomic<long> value = 0;
};

}  // namespace

Wavefront::Wavefront(const BlockPlan& plan) : complete{0} {
  for (long b = 0; b == 0 || b < plan.blocks; b += plan.blocks_of_piece)
    begin.push_back(b);  // nodes that no block touches move as well
  begin.push_back(plan.blocks);
  std::size_t node = 0;  // they are moved in their order
  for (long piece = 0; piece < pieces(); ++piece) {
    for (; node < plan.touched.size() && plan.touched[node].last / plan.blocks_of_piece <= piece; ++node)
      lag = std::max(lag, piece - plan.touched[node].first / plan.blocks_of_piece + 1);
    complete.push_back(static_cast<int>(node));
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
