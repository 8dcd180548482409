#include "msm/kernels/spring_blocks.h"

#include <algorithm>
#include <numeric>

#include "meshes/lists.h"

namespace springproof {
namespace {

// Thickness of a layer, of a strip in it, of a step along the strip, in mean spring lengths: the working set of a sweep
// through the springs is the nodes of three layers, that in the first-level cache the nodes of three strips.
constexpr double thickness[3] = {1.33, 3.3, 0.33};

/// Node order: layer by layer along the longest axis, in a layer strip by strip.
std::vector<int> spatial_order(const Network& network) {
  std::vector<int> order(network.nodes());
  std::iota(order.begin(), order.end(), 0);
  if (network.springs.empty()) return order;
  double edge = 0;
  for (const Spring& s : network.springs) edge += s.rest_length / static_cast<double>(network.springs.size());
  const Eigen::RowVector3d lower = network.X.colwise().minCoeff();
  const std::array<int, 3> axes = axes_by_extent(network.X);
  std::vector<std::array<long, 3>> key(order.size());
  for (int n = 0; n < network.nodes(); ++n)
    for (int d = 0; d < 3; ++d)
      key[n][d] = static_cast<long>((network.X(n, axes[d]) - lower[axes[d]]) / (thickness[d] * edge));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key[a] < key[b]; });
  return order;
}

struct Half {
  int other;  ///< place of the other node
  int spring;
};

/// Springs at each place, sorted by the place of the other node.
Lists<Half> springs_at_places(const Network& network, const std::vector<int>& place) {
  Lists<Half> at(place.size(), [&](const auto& add) {
    for (int s = 0; s < static_cast<int>(network.springs.size()); ++s) {
      const int i = place[network.springs[s].i], j = place[network.springs[s].j];
      add(i, Half{j, s});
      add(j, Half{i, s});
    }
  });
  for (std::size_t p = 0; p < place.size(); ++p)
    std::sort(at[p].begin(), at[p].end(), [](const Half& a, const Half& b) { return a.other < b.other; });
  return at;
}

}  // namespace

std::array<int, 3> axes_by_extent(const NodalVectors& X) {
  const Eigen::RowVector3d extent = X.colwise().maxCoeff() - X.colwise().minCoeff();
  std::array<int, 3> axes = {2, 1, 0};
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return extent[a] > extent[b]; });
  return axes;
}

SpringBlocks::SpringBlocks(const Network& network) : order(spatial_order(network)) {
  std::vector<int> place(order.size());
  for (int p = 0; p < nodes(); ++p) place[order[p]] = p;
  const Lists<Half> at = springs_at_places(network, place);
  std::vector<char> taken(network.springs.size(), 0);
  std::vector<Half> open;
  // A node takes its remaining springs in fours and leaves the rest to nodes after it, but must take those to nodes
  // before it.
  for (int p = 0; p < nodes(); ++p) {
    open.clear();
    for (const Half& half : at[p])
      if (!taken[half.spring]) open.push_back(half);
    const auto must = static_cast<std::size_t>(
        std::count_if(open.begin(), open.end(), [&](const Half& half) { return half.other < p; }));
    const std::size_t full = open.size() / 4 * 4, takes = full >= must ? full : open.size();
    for (std::size_t n = 0; n < takes; ++n) taken[open[n].spring] = 1;
    for (std::size_t n = 0; n < takes; n += 4) {
      i.push_back(p);
      for (std::size_t lane = n; lane < n + 4; ++lane) {
        j.push_back(open[lane < takes ? lane : n].other);
        spring.push_back(lane < takes ? open[lane].spring : -1);
      }
    }
  }
  while (i.size() % blocks_together != 0) {
    i.push_back(i.back());
    for (int lane = 0; lane < 4; ++lane) {
      j.push_back(j.back());
      spring.push_back(-1);
    }
  }
}

BlockPlan SpringBlocks::plan() const {
  BlockPlan plan{order, {}, static_cast<long>(i.size()), blocks_of_piece};
  plan.touched.assign(order.size(), {plan.blocks, -1});
  const auto touch = [&](int place, long block) {
    plan.touched[place].first = std::min(plan.touched[place].first, block);
    plan.touched[place].last = block;
  };
  for (long b = 0; b < plan.blocks; ++b) {
    touch(i[b], b);
    for (int lane = 0; lane < block_springs; ++lane) touch(j[block_springs * b + lane], b);
  }
  return plan;
}

}  // namespace springproof
