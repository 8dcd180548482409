#include "msm/multigrid/thin_parts.h"

#include <algorithm>
#include <iterator>
#include <unordered_map>

namespace springproof {
namespace {

using Index = std::array<int, 3>;

constexpr int thickness = 4;       // cells: parts that contain a cube of this edge are bulky
constexpr int reach = 2;           // cells from bulk: staircases of a curved surface are not thin parts
constexpr int overlap = 3;         // cells by which a thin part reaches into the bulk
constexpr int most_blocks = 1000;  // above it larger ones, of at most
constexpr int largest_block = 4;   // points along each side
constexpr double regularisation = 1e-6;

/// Marks in the box of a level's cells.
struct Marks {
  Index size;
  std::vector<char> mark;

  char& at(int i, int j, int k) { return mark[(std::size_t(k) * size[1] + j) * size[0] + i]; }

  /// Along each axis in turn a mark becomes the least (erosion) or largest (dilation) of those from `low` <= 0 to
  /// `high` >= 0 away; none beyond the box.
  template <class Choose>
  void filter(int low, int high, Choose choose) {
    for (std::size_t axis = 0, step = 1; axis < 3; step *= size[axis++]) {
      std::vector<char> line(size[axis]);
      for (std::size_t start = 0; start < mark.size(); ++start) {
        if ((start / step) % size[axis] != 0) continue;
        for (int i = 0; i < size[axis]; ++i) {
          line[i] = mark[start + i * step];
          for (int d = low; d <= high; ++d)
            line[i] = choose(line[i], i + d >= 0 && i + d < size[axis] ? mark[start + (i + d) * step] : char(0));
        }
        for (int i = 0; i < size[axis]; ++i) mark[start + i * step] = line[i];
      }
    }
  }
};

void dilate(Marks& marks, int by) {
  marks.filter(-by, by, [](char a, char b) { return std::max(a, b); });
}

/// The cells of thin parts; no marks if there are none.
Marks thin_cells(const LatticeLevel& level) {
  const Index& side = level.cells_per_side;
  const bool whole_box = level.cells() == long(side[0]) * side[1] * side[2];
  if (whole_box && *std::min_element(side.begin(), side.end()) >= thickness) return {};
  Marks body{side, std::vector<char>(std::size_t(side[0]) * side[1] * side[2], 0)};
  for (const Index& c : level.cell_index) body.at(c[0], c[1], c[2]) = 1;
  Marks bulk = body;
  bulk.filter(0, thickness - 1, [](char a, char b) { return std::min(a, b); });
  bulk.filter(1 - thickness, 0, [](char a, char b) { return std::max(a, b); });
  dilate(bulk, reach);
  Marks thin = body;
  std::size_t count = 0;
  for (std::size_t i = 0; i < thin.mark.size(); ++i) count += thin.mark[i] = body.mark[i] && !bulk.mark[i];
  if (count == 0) return {};
  dilate(thin, overlap + reach);
  for (std::size_t i = 0; i < thin.mark.size(); ++i) thin.mark[i] = thin.mark[i] && body.mark[i];
  return thin;
}

/// The six rigid motions of a block at one of its points: columns are three translations and three rotations.
Eigen::Matrix<double, 3, 6> rigid_motions(const Eigen::Vector3f& arm, const bool* free) {
  Eigen::Matrix<double, 3, 6> Z;
  Z << 1, 0, 0, 0, arm[2], -arm[1], 0, 1, 0, -arm[2], 0, arm[0], 0, 0, 1, arm[1], -arm[0], 0;
  for (int a = 0; a < 3; ++a)
    if (!free[a]) Z.row(a).setZero();
  return Z;
}

/// The blocks that points of one cell belong to, each with its rigid motions at the cell's corners.
struct CellMotions {
  int count = 0;
  std::array<int, 8> block;
  std::array<Eigen::Matrix<double, 24, 6>, 8> Z;

  Eigen::Matrix<double, 24, 6>& of(int wanted) {
    int s = 0;
    while (s < count && block[s] != wanted) ++s;
    if (s == count) {
      block[count++] = wanted;
      Z[s].setZero();
    }
    return Z[s];
  }
};

}  // namespace

std::unique_ptr<ThinParts> ThinParts::of(const LatticeLevel& level, const CellMatrix& cell) {
  std::unique_ptr<ThinParts> thin(new ThinParts(level.stride()));
  const std::vector<int> number = thin->find_points(level);
  if (thin->points_.empty()) return nullptr;
  thin->form_blocks(level);
  thin->take_rows(level, number);
  thin->K_ = std::make_unique<LatticeOperator<float>>(*thin->rows_, cell);
  thin->factor(number, level.edge_ratio * cell);
  thin->residual_.resize(3 * thin->stride_);
  return thin;
}

/// The corners of thin cells; returns the number in points_ of each point of the level, -1: none.
std::vector<int> ThinParts::find_points(const LatticeLevel& level) {
  std::vector<int> number(level.points(), -1);
  Marks thin = thin_cells(level);
  if (thin.mark.empty()) return number;
  for (const CellRow& row : level.rows)
    for (int i = 0; i < row.length; ++i) {
      const Index& c = level.cell_index[row.cell + i];
      if (!thin.at(c[0], c[1], c[2])) continue;
      for (int n = 0; n < 8; ++n) {
        const long p = LatticeLevel::corner(row, i, n);
        if (number[p] >= 0) continue;
        number[p] = static_cast<int>(points_.size());
        points_.emplace_back().place = p;
      }
    }
  for (int place : level.fixed)
    if (const int p = number[place % stride_]; p >= 0) points_[p].free[place / stride_] = false;
  return number;
}

void ThinParts::form_blocks(const LatticeLevel& level) {
  int side = 2;
  while (side<largest_block&& static_cast<long>(points_.size())> most_blocks * side * side * side) ++side;
  std::unordered_map<long, int> block_at;
  for (Point& point : points_) {
    const Index& at = level.point_index[point.place];
    const Index b = {at[0] / side, at[1] / side, at[2] / side};
    const long key = (long(b[2]) * (level.cells_per_side[1] + 1) + b[1]) * (level.cells_per_side[0] + 1) + b[0];
    point.block = block_at.emplace(key, static_cast<int>(block_at.size())).first->second;
    for (int a = 0; a < 3; ++a)
      point.arm[a] = static_cast<float>(level.arms[a] * (at[a] - (b[a] * side + (side - 1) / 2.0)));
  }
  blocks_ = static_cast<long>(block_at.size());
}

/// The rows of the level whose cells touch the points.
void ThinParts::take_rows(const LatticeLevel& level, const std::vector<int>& number) {
  rows_ = std::make_unique<LatticeLevel>();
  rows_->cells_per_side = level.cells_per_side;
  rows_->point_begin = level.point_begin;
  rows_->cell_begin = level.cell_begin;
  rows_->fill = level.fill;
  rows_->edge_ratio = level.edge_ratio;
  const auto touches = [&](const CellRow& row) {
    for (long first : row.point)
      if (std::any_of(&number[first], &number[first] + row.length + 1, [](int p) { return p >= 0; })) return true;
    return false;
  };
  for (int k = 0; k < level.planes(); ++k) {
    rows_->row_begin.push_back(static_cast<long>(rows_->rows.size()));
    std::copy_if(level.rows.begin() + level.row_begin[k], level.rows.begin() + level.row_begin[k + 1],
                 std::back_inserter(rows_->rows), touches);
  }
  rows_->row_begin.push_back(static_cast<long>(rows_->rows.size()));
}

/// Factors Z^T K Z, `cell` of the level's edge.
void ThinParts::factor(const std::vector<int>& number, const CellMatrix& cell) {
  using Coupling = Eigen::Matrix<double, 6, 6>;
  std::unordered_map<long, Coupling> coupling;  // by pair of blocks, the later one first
  CellMotions motions;
  for (const CellRow& row : rows_->rows)
    for (int i = 0; i < row.length; ++i) {
      motions.count = 0;
      for (int n = 0; n < 8; ++n) {
        const int p = number[LatticeLevel::corner(row, i, n)];
        if (p >= 0) motions.of(points_[p].block).middleRows<3>(3 * n) = rigid_motions(points_[p].arm, points_[p].free);
      }
      const double fill = rows_->fill.empty() ? 1 : rows_->fill[row.cell + i];
      for (int t = 0; t < motions.count; ++t) {
        const Eigen::Matrix<double, 24, 6> KZ = fill * cell * motions.Z[t];
        for (int s = 0; s < motions.count; ++s)
          if (motions.block[s] >= motions.block[t])
            coupling.try_emplace(motions.block[s] * blocks_ + motions.block[t], Coupling::Zero()).first->second +=
                motions.Z[s].transpose() * KZ;
      }
    }
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [pair, part] : coupling) {
    const long row = pair / blocks_, column = pair % blocks_;
    for (int s = 0; s < 6; ++s)
      for (int t = 0; t < (row == column ? s + 1 : 6); ++t)
        entries.emplace_back(6 * row + s, 6 * column + t, part(s, t));
  }
  // A block of few or fixed points has rigid motions that move none of them.
  const double small = regularisation * cell.diagonal().mean();
  for (long i = 0; i < 6 * blocks_; ++i) entries.emplace_back(i, i, small);
  Eigen::SparseMatrix<double> A(6 * blocks_, 6 * blocks_);
  A.setFromTriplets(entries.begin(), entries.end());
  factors_.compute(A);
}

void ThinParts::correct(const float* r, float* z) {
  K_->pass(z, nullptr, nullptr, [&](int a, long begin, long n, const float* y) {
    const long at = a * stride_ + begin;
    residual_.segment(at, n) = Eigen::Map<const Eigen::VectorXf>(r + at, n) - Eigen::Map<const Eigen::VectorXf>(y, n);
  });
  Eigen::VectorXd b = Eigen::VectorXd::Zero(6 * blocks_);
  for (const Point& p : points_) {
    const Vec3 force(residual_[p.place], residual_[p.place + stride_], residual_[p.place + 2 * stride_]);
    b.segment<6>(6 * p.block) += rigid_motions(p.arm, p.free).transpose() * force;
  }
  const Eigen::VectorXd q = factors_.solve(b);
  for (const Point& p : points_) {
    const Vec3 u = rigid_motions(p.arm, p.free) * q.segment<6>(6 * p.block);
    for (int a = 0; a < 3; ++a) z[p.place + a * stride_] += static_cast<float>(u[a]);
  }
}

}  // namespace springproof
