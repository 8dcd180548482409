#include "msm/kernels/cell_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "msm/kernels/spring_blocks.h"

namespace springproof {
namespace {

constexpr int cells_of_piece = 128;

std::vector<int> one_by_one(std::size_t count) {
  std::vector<int> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

std::vector<int> rows_of_layers(const Network& network) {
  const std::array<int, 3> axes = axes_by_extent(network.X);
  const Eigen::RowVector3d lower = network.X.colwise().minCoeff();
  std::vector<std::array<long, 3>> key(network.cells.size());
  for (std::size_t c = 0; c < key.size(); ++c)
    for (int d = 0; d < 3; ++d)
      key[c][d] = std::lround((network.X(network.cells.corners[c][0], axes[d]) - lower[axes[d]]) /
                              (network.cells.edge * network.cells.proportions[axes[d]]));
  std::vector<int> cells = one_by_one(key.size());
  std::stable_sort(cells.begin(), cells.end(), [&](int a, int b) { return key[a] < key[b]; });
  return cells;
}

}  // namespace

CellOrder::CellOrder(const Network& network, int cells_of_block) : cells(rows_of_layers(network)) {
  const long blocks = (static_cast<long>(cells.size()) + cells_of_block - 1) / cells_of_block;
  std::vector<long> last_cell(network.nodes(), -1);  // in the order of the cells
  std::vector<BlockRange> touched(network.nodes(), {blocks, -1});
  const auto touch = [&](int node, long cell) {
    last_cell[node] = std::max(last_cell[node], cell);
    touched[node].first = std::min(touched[node].first, cell / cells_of_block);
    touched[node].last = std::max(touched[node].last, cell / cells_of_block);
  };
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const int node : network.cells.corners[cells[c]]) touch(node, static_cast<long>(c));

  std::vector<long> cell_of(network.anchors.size());
  for (std::size_t a = 0; a < cell_of.size(); ++a) cell_of[a] = std::max(last_cell[network.anchors[a].corners[0]], 0L);
  anchors = one_by_one(cell_of.size());
  std::stable_sort(anchors.begin(), anchors.end(), [&](int a, int b) { return cell_of[a] < cell_of[b]; });
  first_anchor.assign(blocks + 1, 0);
  for (const long cell : cell_of) ++first_anchor[cell / cells_of_block + 1];
  std::partial_sum(first_anchor.begin(), first_anchor.end(), first_anchor.begin());
  for (std::size_t a = 0; a < cell_of.size(); ++a) {
    for (const int node : network.anchors[a].corners) touch(node, cell_of[a]);
    touch(network.anchors[a].node, cell_of[a]);
  }

  plan = {one_by_one(network.nodes()), {}, blocks, std::max(1, cells_of_piece / cells_of_block)};
  std::stable_sort(plan.order.begin(), plan.order.end(), [&](int a, int b) { return last_cell[a] < last_cell[b]; });
  place.resize(network.nodes());
  for (int p = 0; p < network.nodes(); ++p) {
    place[plan.order[p]] = p;
    plan.touched.push_back(touched[plan.order[p]]);
  }
}

}  // namespace springproof
