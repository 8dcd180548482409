#include "msm/multigrid/hierarchy.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace springproof {
namespace {

using Index = std::array<int, 3>;

Index plus(const Index& a, const std::array<int, 3>& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Index half(const Index& a) { return {a[0] / 2, a[1] / 2, a[2] / 2}; }

/// Dense numbering of a box of lattice points or cells; -1 = not in the body.
struct Numbering {
  Index size;
  std::vector<int> number;

  explicit Numbering(const Index& box) : size(box), number(std::size_t(box[0]) * box[1] * box[2], -1) {}
  Numbering(const Index& box, const std::vector<Index>& in_order) : Numbering(box) {
    for (std::size_t n = 0; n < in_order.size(); ++n) at(in_order[n]) = static_cast<int>(n);
  }
  std::size_t place(const Index& p) const { return (std::size_t(p[2]) * size[1] + p[1]) * size[0] + p[0]; }
  int& at(const Index& p) { return number[place(p)]; }
  int get(const Index& p) const {
    for (int d = 0; d < 3; ++d)
      if (p[d] < 0 || p[d] >= size[d]) return -1;
    return number[place(p)];
  }
  /// Numbers and lists the marked entries, x fastest.  Returns the first of each plane, and the end.
  std::vector<long> number_marked(std::vector<Index>& list) {
    std::vector<long> begin;
    int* at = number.data();
    for (int k = 0; k < size[2]; ++k) {
      begin.push_back(static_cast<long>(list.size()));
      for (int j = 0; j < size[1]; ++j)
        for (int i = 0; i < size[0]; ++i, ++at)
          if (*at >= 0) {
            *at = static_cast<int>(list.size());
            list.push_back({i, j, k});
          }
    }
    begin.push_back(static_cast<long>(list.size()));
    return begin;
  }
};

Numbering numbering_of_points(const LatticeLevel& level) {
  return {plus(level.cells_per_side, {1, 1, 1}), level.point_index};
}

/// Builds a level of the marked cells: numbers them and their corners, and sets the rows.
LatticeLevel lay_out(Numbering& cells, double edge_ratio) {
  LatticeLevel level;
  level.edge_ratio = edge_ratio;
  level.cells_per_side = cells.size;
  level.cell_begin = cells.number_marked(level.cell_index);
  Numbering points(plus(cells.size, {1, 1, 1}));
  for (const Index& cell : level.cell_index)
    for (const auto& corner : hexahedron_corners) points.at(plus(cell, corner)) = 0;
  level.point_begin = points.number_marked(level.point_index);
  int plane = 0;
  for (std::size_t c = 0; c < level.cell_index.size(); ++c) {
    const Index& at = level.cell_index[c];
    for (; plane <= at[2]; ++plane) level.row_begin.push_back(static_cast<long>(level.rows.size()));
    const bool goes_on = c > 0 && level.cell_index[c - 1] == Index{at[0] - 1, at[1], at[2]} &&
                         level.rows.back().length < longest_cell_row;
    if (!goes_on) {
      CellRow row;
      row.cell = static_cast<long>(c);
      for (int k = 0; k < 4; ++k) row.point[k] = points.at({at[0], at[1] + k % 2, at[2] + k / 2});
      level.rows.push_back(row);
    }
    ++level.rows.back().length;
  }
  for (; plane <= cells.size[2]; ++plane) level.row_begin.push_back(static_cast<long>(level.rows.size()));
  return level;
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

void lay_out_finest(const Network& network, const std::vector<char>& fixed, const std::vector<double>& fill,
                    LatticeLevels& all) {
  const Grid& grid = *network.cells.grid;
  all.axes = order_axes(grid.cells);
  Numbering cells(reorder(grid.cells, all.axes));
  for (const Index& c : grid.cell_index) cells.at(reorder(c, all.axes)) = 0;
  LatticeLevel level = lay_out(cells, 1);
  Numbering points = numbering_of_points(level);
  all.cell_of_cell.resize(network.cells.size());
  all.point_of_node.resize(network.nodes());
  level.fill.resize(fill.size());
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const int number = all.cell_of_cell[c] = cells.at(reorder(grid.cell_index[c], all.axes));
    if (!fill.empty()) level.fill[number] = fill[c];
    for (int n = 0; n < 8; ++n)
      all.point_of_node[network.cells.corners[c][n]] =
          points.at(reorder(plus(grid.cell_index[c], hexahedron_corners[n]), all.axes));
  }
  for (int n = 0; n < network.nodes(); ++n)
    for (int a = 0; a < 3; ++a)
      if (fixed[3 * n + all.axes[a]])
        level.fixed.push_back(static_cast<int>(a * level.stride() + all.point_of_node[n]));
  std::sort(level.fixed.begin(), level.fixed.end());
  for (int a = 0; a < 3; ++a) level.arms[a] = std::pow(all.proportions[all.axes[a]], 2);
  all.levels.push_back(std::move(level));
}

void set_transfer(const LatticeLevel& fine, Numbering& coarse_points, LatticeLevel& coarse) {
  for (std::size_t n = 0; n < fine.point_index.size(); ++n) {
    const Index& at = fine.point_index[n];
    if (n > 0 && fine.point_index[n - 1] == Index{at[0] - 1, at[1], at[2]} &&
        coarse.transfer.back().length < longest_cell_row) {
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
      for (int y = 0; y <= at[1] % 2; ++y)
        row.coarse[k++] = coarse_points.at({at[0] / 2, at[1] / 2 + y, at[2] / 2 + z});
    coarse.transfer.push_back(row);
  }
}

void set_fixed(const LatticeLevel& fine, const Numbering& fine_points, LatticeLevel& coarse) {
  std::vector<char> fine_fixed(3 * fine.points(), 0);
  for (int place : fine.fixed) fine_fixed[place / fine.stride() * fine.points() + place % fine.stride()] = 1;
  std::vector<int> sources;
  std::vector<char> held(3 * coarse.points(), 0);
  for (std::size_t n = 0; n < coarse.point_index.size(); ++n) {
    const Index at = {2 * coarse.point_index[n][0], 2 * coarse.point_index[n][1], 2 * coarse.point_index[n][2]};
    sources.clear();
    if (const int same = fine_points.get(at); same >= 0) {
      sources.push_back(same);
    } else {
      for (int k = 0; k < 27; ++k)
        if (const int near = fine_points.get({at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1}); near >= 0)
          sources.push_back(near);
    }
    for (int s : sources)
      for (int a = 0; a < 3; ++a) held[a * coarse.points() + n] |= fine_fixed[a * fine.points() + s];
  }
  for (int a = 0; a < 3; ++a)
    for (long n = 0; n < coarse.points(); ++n)
      if (held[a * coarse.points() + n]) coarse.fixed.push_back(static_cast<int>(a * coarse.stride() + n));
}

/// The coarser level, of the cells that contain those of a finer one, with the transfer between them.
LatticeLevel coarsen(const LatticeLevel& fine) {
  Index size;
  for (int d = 0; d < 3; ++d) size[d] = (fine.cells_per_side[d] + 1) / 2;
  Numbering cells(size);
  for (const Index& cell : fine.cell_index) cells.at(half(cell)) = 0;
  LatticeLevel coarse = lay_out(cells, 2 * fine.edge_ratio);
  coarse.arms = fine.arms;
  coarse.fill.assign(coarse.cell_index.size(), 0);
  for (std::size_t c = 0; c < fine.cell_index.size(); ++c) {
    coarse.parent.push_back(cells.at(half(fine.cell_index[c])));
    coarse.fill[coarse.parent.back()] += (fine.fill.empty() ? 1 : fine.fill[c]) / 8;
  }
  if (std::all_of(coarse.fill.begin(), coarse.fill.end(), [](double f) { return f == 1; })) coarse.fill.clear();
  Numbering points = numbering_of_points(coarse);
  set_transfer(fine, points, coarse);
  set_fixed(fine, numbering_of_points(fine), coarse);
  return coarse;
}

}  // namespace

long LatticeLevel::corner(const CellRow& row, int i, int c) {
  const auto& at = hexahedron_corners[c];
  return row.point[at[1] + 2 * at[2]] + i + at[0];
}

void LatticeLevels::to_rows(Nodal kind, const Eigen::VectorXd& nodal, Eigen::VectorXd& rows) const {
  const long stride = levels[0].stride();
  const Vec3 unit = kind == Nodal::forces ? proportions : proportions.cwiseInverse();
  rows.setZero(3 * stride);
  for (std::size_t n = 0; n < point_of_node.size(); ++n)
    for (int a = 0; a < 3; ++a)
      rows[a * stride + point_of_node[n]] = unit[axes[a]] * nodal[3 * static_cast<long>(n) + axes[a]];
}

void LatticeLevels::from_rows(Nodal kind, const Eigen::VectorXd& rows, Eigen::VectorXd& nodal) const {
  const long stride = levels[0].stride();
  const Vec3 unit = kind == Nodal::forces ? proportions.cwiseInverse() : proportions;
  nodal.resize(3 * static_cast<long>(point_of_node.size()));
  for (std::size_t n = 0; n < point_of_node.size(); ++n)
    for (int a = 0; a < 3; ++a)
      nodal[3 * static_cast<long>(n) + axes[a]] = unit[axes[a]] * rows[a * stride + point_of_node[n]];
}

LatticeLevels lattice_levels(const Network& network, const std::vector<char>& fixed, int coarsest_unknowns,
                             const std::vector<double>& fill) {
  if (!network.cells.grid) throw std::invalid_argument("multigrid needs a network made from a lattice of cells");
  LatticeLevels all;
  all.proportions = network.cells.proportions;
  lay_out_finest(network, fixed, fill, all);
  const auto longest = [](const LatticeLevel& l) {
    return *std::max_element(l.cells_per_side.begin(), l.cells_per_side.end());
  };
  while (3 * all.levels.back().points() > coarsest_unknowns && longest(all.levels.back()) >= 2)
    all.levels.push_back(coarsen(all.levels.back()));
  return all;
}

}  // namespace springproof
