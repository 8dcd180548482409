#include "msm/multigrid/lattice_operator.h"

#include <algorithm>
#include <stdexcept>

namespace springproof {
namespace {

/// Sign patterns of a cell's corners: bit d of pattern t set = the sign is that of the corner along axis d.
double sign(int pattern, int corner) {
  double s = 1;
  for (int d = 0; d < 3; ++d)
    if (pattern >> d & 1) s *= 2 * hexahedron_corners[corner][d] - 1;
  return s;
}

}  // namespace

CellMatrix reorder(const CellMatrix& cell, const std::array<int, 3>& axes) {
  std::array<int, 24> from;
  for (int n = 0; n < 8; ++n) {
    std::array<int, 3> at;
    for (int a = 0; a < 3; ++a) at[axes[a]] = hexahedron_corners[n][a];
    const auto found = std::find(hexahedron_corners.begin(), hexahedron_corners.end(), at);
    for (int a = 0; a < 3; ++a) from[3 * n + a] = 3 * static_cast<int>(found - hexahedron_corners.begin()) + axes[a];
  }
  CellMatrix K;
  for (int i = 0; i < 24; ++i)
    for (int j = 0; j < 24; ++j) K(i, j) = cell(from[i], from[j]);
  return K;
}

CellMatrix cell_of_levels(const CellMatrix& cell, const LatticeLevels& lattice) {
  const CellVector p = lattice.proportions.replicate<8, 1>();
  return reorder(p.asDiagonal() * cell * p.asDiagonal(), lattice.axes);
}

template <class Real>
CellBlocks<Real> cell_blocks(const CellMatrix& cell, double gradient) {
  CellMatrix H = CellMatrix::Zero();  // row 3 t + a: pattern t of component a
  for (int t = 0; t < 8; ++t)
    for (int n = 0; n < 8; ++n)
      for (int a = 0; a < 3; ++a) H(3 * t + a, 3 * n + a) = sign(t, n);
  const CellMatrix M = H * cell * H.transpose() / 64;
  CellBlocks<Real> blocks;
  CellMatrix rest = M;
  for (int t = 0; t < 8; ++t) {
    int k = 0;
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b, ++k) {
        const int i = 3 * (t ^ 1 << a) + a, j = 3 * (t ^ 1 << b) + b;
        blocks.m[t][k] = static_cast<Real>((M(i, j) + M(j, i)) / 2);
        rest(i, j) = rest(j, i) = 0;
      }
  }
  if (rest.cwiseAbs().maxCoeff() > 1e-10 * M.cwiseAbs().maxCoeff())
    throw std::invalid_argument("the cells of this lattice lack three mirror planes");
  blocks.gradient = static_cast<Real>(gradient);
  return blocks;
}

BlockMatrix assemble(const LatticeLevel& level, const CellMatrix& cell) {
  std::vector<Hexahedron> cells;
  for (const CellRow& row : level.rows)
    for (int i = 0; i < row.length; ++i) {
      Hexahedron& corners = cells.emplace_back();
      for (int n = 0; n < 8; ++n) corners[n] = static_cast<int>(LatticeLevel::corner(row, i, n));
    }
  BlockMatrix K(coupled_nodes(static_cast<int>(level.points()), cells));
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const double scale = level.edge_ratio * (level.fill.empty() ? 1 : level.fill[c]);
    for (int m = 0; m < 8; ++m)
      for (int n = 0; n < 8; ++n) K.add(cells[c][m], cells[c][n], scale * cell.block<3, 3>(3 * m, 3 * n));
  }
  return K;
}

Eigen::VectorXd diagonal(const LatticeLevel& level, const CellMatrix& cell) {
  Eigen::VectorXd d = Eigen::VectorXd::Zero(3 * level.stride());
  for (const CellRow& row : level.rows)
    for (int i = 0; i < row.length; ++i) {
      const double scale = level.edge_ratio * (level.fill.empty() ? 1 : level.fill[row.cell + i]);
      for (int n = 0; n < 8; ++n)
        for (int a = 0; a < 3; ++a)
          d[a * level.stride() + LatticeLevel::corner(row, i, n)] += scale * cell(3 * n + a, 3 * n + a);
    }
  return d;
}

template <class Real>
LatticeOperator<Real>::LatticeOperator(const LatticeLevel& level, const CellMatrix& cell, double gradient,
                                       InstructionSet set)
    : level_(&level),
      kernels_(&kernels_of<Real>(set).cells),
      blocks_(cell_blocks<Real>(level.edge_ratio * cell, level.edge_ratio * level.edge_ratio * gradient)),
      stride_(level.stride()) {
  if (!level.fill.empty()) {
    fill_ = Vector::Zero(level.cells() + array_slack);
    for (long c = 0; c < level.cells(); ++c) fill_[c] = static_cast<Real>(level.fill[c]);
  }
  long largest = 0;
  for (std::size_t k = 0; k + 1 < level.point_begin.size(); ++k)
    largest = std::max(largest, level.point_begin[k + 1] - level.point_begin[k]);
  plane_size_ = largest + array_slack;
  planes_ = Vector::Zero(9 * plane_size_);
}

template <class Real>
PlanePair<Real> LatticeOperator<Real>::pair(int k) {
  return {{plane(k, 0), plane(k, 1), plane(k, 2)},
          {plane(k + 1, 0), plane(k + 1, 1), plane(k + 1, 2)},
          level_->point_begin[k],
          level_->point_begin[k + 1]};
}

template <class Real>
void LatticeOperator<Real>::divergence_of_planes(int k, Real* divergence) {
  kernels_->divergence(blocks_.gradient, level_->rows.data() + level_->row_begin[k],
                       level_->row_begin[k + 1] - level_->row_begin[k], pair(k), fill_.size() ? fill_.data() : nullptr,
                       divergence);
}

template <class Real>
void LatticeOperator<Real>::divergence(const Real* u, Real* divergence) {
  Real* v = const_cast<Real*>(u);  // only read
  const PlanePair<Real> whole = {{v, v + stride_, v + 2 * stride_}, {v, v + stride_, v + 2 * stride_}, 0, 0};
  kernels_->divergence(blocks_.gradient, level_->rows.data(), static_cast<long>(level_->rows.size()), whole,
                       fill_.size() ? fill_.data() : nullptr, divergence);
}

template CellBlocks<float> cell_blocks<float>(const CellMatrix&, double);
template CellBlocks<double> cell_blocks<double>(const CellMatrix&, double);
template class LatticeOperator<float>;
template class LatticeOperator<double>;

}  // namespace springproof
