#include "msm/algebra/block_matrix.h"

#include <algorithm>
#include <cassert>

namespace springproof {

BlockMatrix::BlockMatrix(const std::vector<std::vector<int>>& coupled) {
  row_begin_.reserve(coupled.size() + 1);
  for (const auto& row : coupled) {
    column_.insert(column_.end(), row.begin(), row.end());
    row_begin_.push_back(static_cast<int>(column_.size()));
  }
  blocks_.assign(column_.size(), Blocks::Zero());
}

BlockMatrix::BlockMatrix(const std::vector<std::vector<int>>& coupled, Carriers carriers) : BlockMatrix(coupled) {
  carriers_ = std::move(carriers);
}

BlockMatrix::BlockMatrix(const Network& network)
    : BlockMatrix(coupled_through(carriers_of(network.nodes(), network.cells.carried), coupled_nodes(network)),
                  carriers_of(network.nodes(), network.cells.carried)) {}

void BlockMatrix::hand_on(int i, int j, const Eigen::Matrix3d& block) {
  for_each_carrier(carriers_, i, [&](int p, double v) {
    for_each_carrier(carriers_, j, [&](int q, double w) { blocks_[find(p, q)] += v * w * block; });
  });
}

void BlockMatrix::set_zero() { std::fill(blocks_.begin(), blocks_.end(), Blocks::Zero()); }

std::size_t BlockMatrix::find(int i, int j) const {
  const auto first = column_.begin() + row_begin_[i], last = column_.begin() + row_begin_[i + 1];
  const auto at = std::lower_bound(first, last, j);
  assert(at != last && *at == j);
  return static_cast<std::size_t>(at - column_.begin());
}

void BlockMatrix::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  y.resize(x.size());
  const double* in = x.data();
  for (int i = 0; i < nodes(); ++i) {
    double s0 = 0, s1 = 0, s2 = 0;
    for (int e = row_begin_[i]; e < row_begin_[i + 1]; ++e) {
      const double* b = blocks_[e].data();
      const double* v = in + 3 * column_[e];
      s0 += b[0] * v[0] + b[1] * v[1] + b[2] * v[2];
      s1 += b[3] * v[0] + b[4] * v[1] + b[5] * v[2];
      s2 += b[6] * v[0] + b[7] * v[1] + b[8] * v[2];
    }
    y[3 * i] = s0;
    y[3 * i + 1] = s1;
    y[3 * i + 2] = s2;
  }
}

Eigen::VectorXd BlockMatrix::diagonal() const {
  Eigen::VectorXd d(3 * nodes());
  for (int i = 0; i < nodes(); ++i) d.segment<3>(3 * i) = blocks_[find(i, i)].diagonal();
  return d;
}

Eigen::SparseMatrix<double> BlockMatrix::lower_triangle(const std::vector<int>& number, int unknowns) const {
  // The pattern is symmetric, so row i of the upper triangle is column i of the lower.
  Eigen::SparseMatrix<double> A(unknowns, unknowns);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(blocks_.size() * 5);
  for (int i = 0; i < nodes(); ++i)
    for (int e = row_begin_[i]; e < row_begin_[i + 1]; ++e)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          const int row = number[3 * i + a], column = number[3 * column_[e] + b];
          if (column >= 0 && row >= column) entries.emplace_back(row, column, blocks_[e](a, b));
        }
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

namespace {

void sort_unique(std::vector<std::vector<int>>& rows) {
  for (auto& row : rows) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
}

}  // namespace

std::vector<std::vector<int>> coupled_through(const Carriers& carriers, const std::vector<std::vector<int>>& coupled) {
  if (carriers.empty()) return coupled;
  std::vector<std::vector<int>> through(coupled.size());
  std::vector<int> columns;
  for (std::size_t i = 0; i < coupled.size(); ++i) {
    columns.clear();
    for (const int j : coupled[i]) {
      if (carriers[j].empty()) columns.push_back(j);
      for (const auto& [q, w] : carriers[j]) columns.push_back(q);
    }
    const auto couple = [&](std::size_t p) { through[p].insert(through[p].end(), columns.begin(), columns.end()); };
    if (carriers[i].empty())
      couple(i);
    else
      through[i] = {static_cast<int>(i)};
    for (const auto& [p, w] : carriers[i]) couple(static_cast<std::size_t>(p));
  }
  sort_unique(through);
  return through;
}

std::vector<std::vector<int>> coupled_nodes(int nodes, const std::vector<Hexahedron>& cells) {
  std::vector<std::vector<int>> coupled(nodes);
  for (int i = 0; i < nodes; ++i) coupled[i].push_back(i);
  for (const Hexahedron& cell : cells)
    for (int a : cell) coupled[a].insert(coupled[a].end(), cell.begin(), cell.end());
  sort_unique(coupled);
  return coupled;
}

std::vector<std::vector<int>> coupled_nodes(const Network& network) {
  auto coupled = coupled_nodes(network.nodes(), network.cells.corners);
  for (const Spring& s : network.springs) {
    coupled[s.i].push_back(s.j);
    coupled[s.j].push_back(s.i);
  }
  for (const Anchor& anchor : network.anchors) {
    coupled[anchor.node].insert(coupled[anchor.node].end(), anchor.corners.begin(), anchor.corners.end());
    for (int a : anchor.corners) coupled[a].push_back(anchor.node);
  }
  for (const InterfaceBond& bond : network.bonds)
    for_each_corner(bond,
                    [&](int a, double) { for_each_corner(bond, [&](int b, double) { coupled[a].push_back(b); }); });
  for (const auto& triangle : network.triangles)
    for (int a : triangle) coupled[a].insert(coupled[a].end(), triangle.begin(), triangle.end());
  sort_unique(coupled);
  return coupled;
}

}  // namespace springproof
