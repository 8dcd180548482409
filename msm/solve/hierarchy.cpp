#include "msm/solve/hierarchy.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace springproof {
namespace {

using Index = std::array<int, 3>;

/// Dense numbering of a box of lattice points or cells; -1 = not in the body.
struct Numbering {
  Index size;
  std::vector<int> number;

  explicit Numbering(const Index& box) : size(box), number(std::size_t(box[0]) * box[1] * box[2], -1) {}
  int& at(const Index& p) { return number[(std::size_t(p[2]) * size[1] + p[1]) * size[0] + p[0]]; }
  int get(const Index& p) const {
    for (int d = 0; d < 3; ++d)
      if (p[d] < 0 || p[d] >= size[d]) return -1;
    return number[(std::size_t(p[2]) * size[1] + p[1]) * size[0] + p[0]];
  }
  /// Calls visit(index) for what is marked, x fastest, and numbers it.  Returns where each plane begins, and the end.
  template <class Visit>
  std::vector<long> number_marked(Visit visit) {
    std::vector<long> begin;
    int next = 0;
    Index p;
    for (p[2] = 0; p[2] < size[2]; ++p[2]) {
      begin.push_back(next);
      for (p[1] = 0; p[1] < size[1]; ++p[1])
        for (p[0] = 0; p[0] < size[0]; ++p[0])
          if (int& n = at(p); n >= 0) {
            n = next++;
            visit(p);
          }
    }
    begin.push_back(next);
    return begin;
  }
};

/// What building the next level needs of one.
struct Indexed {
  Numbering cells, points;
};

Index plus(const Index& a, const std::array<int, 3>& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Index half(const Index& a) { return {a[0] / 2, a[1] / 2, a[2] / 2}; }

/// Numbers the marked cells and their corners, and lays out the rows of a level.
Indexed lay_out(Numbering cells, LatticeLevel& level) {
  Indexed indexed{std::move(cells), Numbering({0, 0, 0})};
  level.cells_per_side = indexed.cells.size;
  level.cell_begin = indexed.cells.number_marked([&](const Index& p) { level.cell_index.push_back(p); });
  indexed.points = Numbering(plus(level.cells_per_side, {1, 1, 1}));
  for (const Index& cell : level.cell_index)
    for (const auto& corner : hexahedron_corners) indexed.points.at(plus(cell, corner)) = 0;
  level.point_begin = indexed.points.number_marked([&](const Index& p) { level.point_index.push_back(p); });
  int plane = 0;
  for (std::size_t c = 0; c < level.cell_index.size(); ++c) {
    const Index& at = level.cell_index[c];
    for (; plane <= at[2]; ++plane) level.row_begin.push_back(static_cast<long>(level.rows.size()));
    const bool goes_on = c > 0 && level.cell_index[c - 1] == Index{at[0] - 1, at[1], at[2]} && level.rows.back().length < longest_cell_row;
    if (!goes_on) {
      CellRow row;
      row.cell = static_cast<long>(c);
      for (int k = 0; k < 4; ++k) row.point[k] = indexed.points.at({at[0], at[1] + k % 2, at[2] + k / 2});
      level.rows.push_back(row);
    }
    ++level.rows.back().length;
  }
  for (; plane <= level.cells_per_side[2]; ++plane) level.row_begin.push_back(static_cast<long>(level.rows.size()));
  return indexed;
}

/// The axis with the least waste in whole vectors of eight first, then the others in order.
std::array<int, 3> order_axes(const Index& cells) {
  const auto waste = [&](int d) { return double((cells[d] + 7) / 8 * 8) / cells[d]; };
  int first = 0;
  for (int d = 1; d < 3; ++d)
    if (waste(d) < waste(first) - 1e-9 || (waste(d) < waste(first) + 1e-9 && cells[d] > cells[first])) first = d;
  std::array<int, 3> axes = {first, 0, 0};
  for (int d = 0, next = 1; d < 3; ++d)
    if (d != first) axes[next++] = d;
  if (cells[axes[1]] > cells[axes[2]]) std::swap(axes[1], axes[2]);  // small planes stay in the cache
  return axes;
}

Index reorder(const Index& p, const std::array<int, 3>& axes) { return {p[axes[0]], p[axes[1]], p[axes[2]]}; }

Indexed lay_out_finest(const Network& network, const std::vector<char>& fixed, const std::vector<double>& fill, LatticeLevels& all) {
  const Grid& grid = *network.grid;
  all.axes = order_axes(grid.cells);
  Numbering cells(reorder(grid.cells, all.axes));
  for (const Index& c : grid.cell_index) cells.at(reorder(c, all.axes)) = 0;
  LatticeLevel& level = all.levels.emplace_back();
  Indexed indexed = lay_out(std::move(cells), level);
  all.cell_of_cell.resize(network.cells.size());
  all.point_of_node.resize(network.nodes());
  level.fill.resize(fill.size());
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const int number = all.cell_of_cell[c] = indexed.cells.at(reorder(grid.cell_index[c], all.axes));
    if (!fill.empty()) level.fill[number] = fill[c];
    for (int n = 0; n < 8; ++n)
      all.point_of_node[network.cells[c][n]] = indexed.points.at(reorder(plus(grid.cell_index[c], hexahedron_corners[n]), all.axes));
  }
  for (int n = 0; n < network.nodes(); ++n)
    for (int a = 0; a < 3; ++a)
      if (fixed[3 * n + all.axes[a]]) level.fixed.push_back(static_cast<int>(a * level.stride() + all.point_of_node[n]));
  std::sort(level.fixed.begin(), level.fixed.end());
  return indexed;
}

Numbering coarsen_cells(const LatticeLevel& fine) {
  Index size;
  for (int d = 0; d < 3; ++d) size[d] = (fine.cells_per_side[d] + 1) / 2;
  Numbering cells(size);
  for (const Index& cell : fine.cell_index) cells.at(half(cell)) = 0;
  return cells;
}

void set_fill(const LatticeLevel& fine, Indexed& indexed, LatticeLevel& coarse) {
  coarse.parent.resize(fine.cell_index.size());
  coarse.fill.assign(coarse.cell_index.size(), 0);
  for (std::size_t c = 0; c < fine.cell_index.size(); ++c) {
    coarse.parent[c] = indexed.cells.at(half(fine.cell_index[c]));
    coarse.fill[coarse.parent[c]] += (fine.fill.empty() ? 1 : fine.fill[c]) / 8;
  }
  if (std::all_of(coarse.fill.begin(), coarse.fill.end(), [](double f) { return f == 1; })) coarse.fill.clear();
}

void set_transfer(const LatticeLevel& fine, Indexed& indexed, LatticeLevel& coarse) {
  for (std::size_t n = 0; n < fine.point_index.size(); ++n) {
    const Index& at = fine.point_index[n];
    if (n > 0 && fine.point_index[n - 1] == Index{at[0] - 1, at[1], at[2]} && coarse.transfer.back().length < longest_cell_row) {
      ++coarse.transfer.back().length;
      continue;
    }
    TransferRow row;
    row.fine = static_cast<long>(n);
    row.length = 1;
    row.odd = at[0] % 2;
    row.count = (1 + at[1] % 2) * (1 + at[2] % 2);
    int k = 0;
    for (int z = 0; z <= at[2] % 2; ++z)
      for (int y = 0; y <= at[1] % 2; ++y) row.coarse[k++] = indexed.points.at({at[0] / 2, at[1] / 2 + y, at[2] / 2 + z});
    coarse.transfer.push_back(row);
  }
}

void set_fixed(const Indexed& fine, const LatticeLevel& fine_level, LatticeLevel& coarse) {
  std::vector<char> fine_fixed(3 * fine_level.points(), 0);
  for (int place : fine_level.fixed) fine_fixed[place / fine_level.stride() * fine_level.points() + place % fine_level.stride()] = 1;
  std::vector<int> sources;
  std::vector<char> held(3 * coarse.points(), 0);
  for (std::size_t n = 0; n < coarse.point_index.size(); ++n) {
    const Index at = {2 * coarse.point_index[n][0], 2 * coarse.point_index[n][1], 2 * coarse.point_index[n][2]};
    sources.clear();
    if (const int same = fine.points.get(at); same >= 0) {
      sources.push_back(same);
    } else {
      for (int k = 0; k < 27; ++k)
        if (const int near = fine.points.get({at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1}); near >= 0)
          sources.push_back(near);
    }
    for (int s : sources)
      for (int a = 0; a < 3; ++a) held[a * coarse.points() + n] |= fine_fixed[a * fine_level.points() + s];
  }
  for (int a = 0; a < 3; ++a)
    for (long n = 0; n < coarse.points(); ++n)
      if (held[a * coarse.points() + n]) coarse.fixed.push_back(static_cast<int>(a * coarse.stride() + n));
}

}  // namespace

long LatticeLevel::corner(const CellRow& row, int i, int c) {
  const auto& at = hexahedron_corners[c];
  return row.point[at[1] + 2 * at[2]] + i + at[0];
}

void LatticeLevels::to_rows(const Eigen::VectorXd& nodal, Eigen::VectorXd& rows) const {
  const long stride = levels[0].stride();
  rows.setZero(3 * stride);
  for (std::size_t n = 0; n < point_of_node.size(); ++n)
    for (int a = 0; a < 3; ++a) rows[a * stride + point_of_node[n]] = nodal[3 * static_cast<long>(n) + axes[a]];
}

void LatticeLevels::from_rows(const Eigen::VectorXd& rows, Eigen::VectorXd& nodal) const {
  const long stride = levels[0].stride();
  nodal.resize(3 * static_cast<long>(point_of_node.size()));
  for (std::size_t n = 0; n < point_of_node.size(); ++n)
    for (int a = 0; a < 3; ++a) nodal[3 * static_cast<long>(n) + axes[a]] = rows[a * stride + point_of_node[n]];
}

LatticeLevels lattice_levels(const Network& network, const std::vector<char>& fixed, int coarsest_unknowns,
                             const std::vector<double>& fill) {
  if (!network.grid) throw std::invalid_argument("multigrid needs a network made from a lattice of cells");
  LatticeLevels all;
  Indexed indexed = lay_out_finest(network, fixed, fill, all);
  const auto longest = [](const LatticeLevel& l) { return *std::max_element(l.cells_per_side.begin(), l.cells_per_side.end()); };
  while (3 * all.levels.back().points() > coarsest_unknowns && longest(all.levels.back()) >= 2) {
    const LatticeLevel& fine = all.levels.back();
    LatticeLevel coarse;
    coarse.edge_ratio = 2 * fine.edge_ratio;
    Indexed coarse_indexed = lay_out(coarsen_cells(fine), coarse);
    set_fill(fine, coarse_indexed, coarse);
    set_transfer(fine, coarse_indexed, coarse);
    set_fixed(indexed, fine, coarse);
    all.levels.push_back(std::move(coarse));
    indexed = std::move(coarse_indexed);
  }
  return all;
}

}  // namespace springproof
