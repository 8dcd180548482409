#include "msm/kernels/cell_forces.h"

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
  std::vector<std::array<long, 4>> key(network.cells.size());  // layer, material, row, place
  for (std::size_t c = 0; c < key.size(); ++c) {
    key[c][1] = network.cells.material(c);
    for (int d = 0; d < 3; ++d)
      key[c][d == 0 ? 0 : d + 1] = std::lround((network.X(network.cells.corners[c][0], axes[d]) - lower[axes[d]]) /
                                               (network.cells.edge * network.cells.proportions[axes[d]]));
  }
  std::vector<int> cells = one_by_one(key.size());
  std::stable_sort(cells.begin(), cells.end(), [&](int a, int b) { return key[a] < key[b]; });
  return cells;
}

/// Cells in their order, with gaps so that each block has one material.
std::vector<int> in_blocks(const Network& network, int cells_of_block) {
  std::vector<int> cells;
  for (const int c : rows_of_layers(network)) {
    if (!cells.empty() && cells.back() >= 0 && network.cells.material(cells.back()) != network.cells.material(c))
      while (cells.size() % cells_of_block != 0) cells.push_back(-1);
    cells.push_back(c);
  }
  return cells;
}

/// What is in the blocks of the cells `of`, in their order.
void sort_into_blocks(const std::vector<long>& of, long blocks, int cells_of_block, std::vector<int>& numbers,
                      std::vector<int>& first) {
  numbers = one_by_one(of.size());
  std::stable_sort(numbers.begin(), numbers.end(), [&](int a, int b) { return of[a] < of[b]; });
  first.assign(blocks + 1, 0);
  for (const long cell : of) ++first[cell / cells_of_block + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
}

}  // namespace

CellOrder::CellOrder(const Network& network, int cells_of_block) : cells(in_blocks(network, cells_of_block)) {
  const long blocks = (static_cast<long>(cells.size()) + cells_of_block - 1) / cells_of_block;
  for (long b = 0; b < blocks; ++b) material.push_back(network.cells.material(cells[b * cells_of_block]));
  std::vector<long> last_cell(network.nodes(), -1);  // in the order of the cells
  std::vector<BlockRange> touched(network.nodes(), {blocks, -1});
  const auto touch = [&](int node, long cell) {
    last_cell[node] = std::max(last_cell[node], cell);
    touched[node].first = std::min(touched[node].first, cell / cells_of_block);
    touched[node].last = std::max(touched[node].last, cell / cells_of_block);
  };
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (cells[c] >= 0)
      for (const int node : network.cells.corners[cells[c]]) touch(node, static_cast<long>(c));

  std::vector<long> cell_of(network.anchors.size()), cell_of_bond;
  for (std::size_t a = 0; a < cell_of.size(); ++a) cell_of[a] = std::max(last_cell[network.anchors[a].corners[0]], 0L);
  for (const InterfaceBond& b : network.bonds)
    cell_of_bond.push_back(std::max(last_cell[b.corners[0][0]], last_cell[b.corners[1][0]]));
  sort_into_blocks(cell_of, blocks, cells_of_block, anchors, first_anchor);
  sort_into_blocks(cell_of_bond, blocks, cells_of_block, bonds, first_bond);
  for (std::size_t a = 0; a < cell_of.size(); ++a) {
    for (const int node : network.anchors[a].corners) touch(node, cell_of[a]);
    touch(network.anchors[a].node, cell_of[a]);
  }
  for (std::size_t b = 0; b < cell_of_bond.size(); ++b)
    for_each_corner(network.bonds[b], [&](int node, double) { touch(node, cell_of_bond[b]); });

  plan = {one_by_one(network.nodes()), {}, blocks, std::max(1, cells_of_piece / cells_of_block)};
  std::stable_sort(plan.order.begin(), plan.order.end(), [&](int a, int b) { return last_cell[a] < last_cell[b]; });
  place.resize(network.nodes());
  for (int p = 0; p < network.nodes(); ++p) {
    place[plan.order[p]] = p;
    plan.touched.push_back(touched[plan.order[p]]);
  }
}

}  // namespace springproof
