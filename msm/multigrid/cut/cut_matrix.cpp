#include "msm/multigrid/cut/cut_matrix.h"

#include <Eigen/LU>
#include <algorithm>
#include <map>

#include "meshes/lists.h"
#include "msm/multigrid/cut/cut_levels.h"

namespace springproof {
namespace {

using CellStiffnessMatrix = Eigen::Matrix<double, 24, 24>;

/// The cells that move with each point, by ascending number.
Lists<int> cells_at_points(const CutLevel& level, const Carriers& carriers) {
  return Lists<int>(level.point.size(), [&](const auto& add) {
    std::vector<int> last(level.point.size(), -1);
    for (int c = 0; c < static_cast<int>(level.corners.size()); ++c)
      for (const int q : level.corners[c])
        for_each_carrier(carriers, q, [&](int p, double) {
          if (last[p] != c) add(p, c);
          last[p] = c;
        });
  });
}

/// Points that a bond couples with each point.
std::vector<std::vector<int>> bonded_points(const CutLevel& level, const Carriers& carriers) {
  std::vector<std::vector<int>> bonded(level.point.size());
  std::vector<int> points;
  for (const InterfaceBond& b : level.bonds) {
    points.clear();
    for_each_corner(b,
                    [&](int n, double) { for_each_carrier(carriers, n, [&](int p, double) { points.push_back(p); }); });
    for (const int p : points) bonded[p].insert(bonded[p].end(), points.begin(), points.end());
  }
  return bonded;
}

std::vector<int> from_bottom_to_top(const std::vector<std::array<int, 3>>& place) {
  std::vector<std::pair<long, int>> key;
  for (std::size_t i = 0; i < place.size(); ++i)
    key.emplace_back((long(place[i][2]) << 42) + (long(place[i][1]) << 21) + place[i][0], static_cast<int>(i));
  std::sort(key.begin(), key.end());
  std::vector<int> order;
  for (const auto& [k, i] : key) order.push_back(i);
  return order;
}

/// Size and material of a cell: full ones of a kind have the same stiffness.
std::pair<int, int> kind_of(const CutLevel& level, std::size_t cell) {
  return {level.cubes[cell].size, level.material(cell)};
}

}  // namespace

template <class Real>
CutMatrix<Real>::CutMatrix(const StiffnessOfCells& cells, double unit, const CutLevel& level,
                           const std::vector<char>& fixed)
    : point_(from_bottom_to_top(level.point)), row_(point_.size()), begin_{0} {
  const int points = rows();
  for (int n = 0; n < points; ++n) row_[point_[n]] = n;
  const Carriers carriers = carriers_of(points, level.carried);
  const Lists<int> at = cells_at_points(level, carriers);
  std::vector<char> own(points, 0), apart(points, 0);
  for (const Anchor& a : level.anchors)
    for (const int q : a.corners) apart[q] = 1;
  const std::vector<std::vector<int>> bonded = bonded_points(level, carriers);
  const auto is_inside = [&](int p) {  // of eight full cells of one size
    if (!cells.full_alike || apart[p] || !bonded[p].empty() || at[p].size() != 8) return false;
    return std::all_of(at[p].begin(), at[p].end(), [&](int c) {
      return level.filled[c].fraction == 1 && kind_of(level, c) == kind_of(level, at[p].front());
    });
  };
  std::map<std::pair<int, int>, int> inside;  // first block of the rows inside, by the kind of their cells
  std::vector<int> seen(points, -1);
  int blocks = 0;
  for (const int p : point_) {
    bool is_shared = is_inside(p);
    const auto start = static_cast<std::ptrdiff_t>(column_.size());
    for (const int c : at[p])
      for (const int q : level.corners[c]) {
        is_shared &= carriers.empty() || carriers[q].empty();
        for_each_carrier(carriers, q, [&](int j, double) {
          if (seen[j] == p) return;
          seen[j] = p;
          column_.push_back(row_[j]);
          for (int a = 0; a < 3 && !fixed.empty(); ++a) is_shared &= !fixed[3 * j + a];
        });
      }
    for (const int j : bonded[p])
      if (seen[j] != p) {
        seen[j] = p;
        column_.push_back(row_[j]);
      }
    std::sort(column_.begin() + start, column_.end());
    diagonal_.push_back(
        static_cast<int>(std::lower_bound(column_.begin() + start, column_.end(), row_[p]) - column_.begin()));
    for (auto e = column_.begin() + start; e != column_.end(); ++e) *e = point_[*e];
    const int entries = static_cast<int>(column_.size()) - begin_.back();
    begin_.push_back(static_cast<int>(column_.size()));
    if (is_shared && entries == 27) {
      const auto [known, is_first] = inside.try_emplace(kind_of(level, at[p].front()), blocks);
      first_.push_back(known->second);
      if (!is_first) continue;
    } else
      first_.push_back(blocks);
    own[p] = 1;
    blocks += entries;
  }
  block_.assign(9 * static_cast<std::size_t>(blocks) + 1, Real(0));

  std::map<std::pair<int, int>, CellStiffnessMatrix> of_full;
  for (std::size_t c = 0; c < level.corners.size(); ++c) {
    const Hexahedron& corners = level.corners[c];
    std::array<bool, 8> needed;
    bool any = false;
    for (int m = 0; m < 8; ++m) {
      needed[m] = false;
      for_each_carrier(carriers, corners[m], [&](int p, double) { needed[m] |= own[p] != 0; });
      any |= needed[m];
    }
    if (!any) continue;
    const bool is_full = cells.full_alike && level.filled[c].fraction == 1;
    const auto known = is_full ? of_full.find(kind_of(level, c)) : of_full.end();
    const CellStiffnessMatrix K = known != of_full.end() ? known->second : cells.of(c) / unit;
    if (is_full) of_full.try_emplace(kind_of(level, c), K);
    for (int m = 0; m < 8; ++m)
      for (int n = 0; n < 8 && needed[m]; ++n)
        for_each_carrier(carriers, corners[m], [&](int p, double v) {
          if (!own[p]) return;
          for_each_carrier(carriers, corners[n], [&](int q, double w) {
            Real* to = own_block(p, q);
            for (int a = 0; a < 3; ++a)
              for (int b = 0; b < 3; ++b) to[3 * a + b] += static_cast<Real>(v * w * K(3 * m + a, 3 * n + b));
          });
        });
  }
  add_bonds(level, unit, carriers);
}

template <class Real>
void CutMatrix<Real>::add_bonds(const CutLevel& level, double unit, const Carriers& carriers) {
  for (const InterfaceBond& bond : level.bonds) {
    std::map<int, double> weights;  // of the points that carry the corners
    for_each_corner(bond, [&](int n, double w) {
      for_each_carrier(carriers, n, [&](int p, double share) { weights[p] += w * share; });
    });
    for (const auto& [p, v] : weights)
      for (const auto& [q, w] : weights) {
        Real* to = own_block(p, q);
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) to[3 * a + b] += static_cast<Real>(v * w * bond.stiffness(a, b) / unit);
      }
  }
}

template <class Real>
template <class Other>
CutMatrix<Real>::CutMatrix(const CutMatrix<Other>& other)
    : point_(other.point_),
      row_(other.row_),
      begin_(other.begin_),
      column_(other.column_),
      first_(other.first_),
      diagonal_(other.diagonal_),
      block_(other.block_.begin(), other.block_.end()) {}

template <class Real>
void CutMatrix<Real>::add_anchors(const CutLevel& level, double unit) {
  const Carriers carriers = carriers_of(rows(), level.carried);
  for (const Anchor& anchor : level.anchors)
    for (int m = 0; m < 8; ++m)
      for (int n = 0; n < 8; ++n)
        for_each_carrier(carriers, anchor.corners[m], [&](int p, double v) {
          for_each_carrier(carriers, anchor.corners[n], [&](int q, double w) {
            const Eigen::Matrix3d K = v * w * anchor.weights[m] * anchor.weights[n] / unit * anchor.stiffness;
            for (int a = 0; a < 3; ++a)
              for (int b = 0; b < 3; ++b) own_block(p, q)[3 * a + b] += static_cast<Real>(K(a, b));
          });
        });
}

template <class Real>
void CutMatrix<Real>::clear_fixed(const std::vector<char>& fixed) {
  if (fixed.empty()) return;
  for (int n = 0; n < rows(); ++n)
    for (int e = begin_[n]; e < begin_[n + 1]; ++e)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          if (fixed[3 * point_[n] + a] || fixed[3 * column_[e] + b])
            block_[9 * static_cast<std::size_t>(first_[n] + e - begin_[n]) + 3 * a + b] = 0;
}

template <class Real>
BlockRows<Real> CutMatrix<Real>::view() const {
  work_.resize(4 * point_.size());
  return {rows(), point_.data(), begin_.data(), begin_.data() + 1, column_.data(), first_.data(), block_.data()};
}

template <class Real>
void CutMatrix<Real>::multiply(const Real* x, Real* y) const {
  const BlockRows<Real> A = view();
  kernels_of<Real>().rows.multiply(A, x, y, work_.data());
}

template <class Real>
void CutMatrix<Real>::residual(const Real* b, const Real* x, Real* r) const {
  const BlockRows<Real> A = view();
  kernels_of<Real>().rows.residual(A, b, x, r, work_.data());
}

template <class Real>
void CutMatrix<Real>::relax(const std::vector<Real>& D, bool ascending, const Real* b, Real* x) const {
  const BlockRows<Real> A = view();
  kernels_of<Real>().rows.relax(A, D.data(), ascending, b, x, work_.data());
}

template <class Real>
void CutMatrix<Real>::relax_from_zero(const std::vector<Real>& D, const Real* b, Real* x) const {
  BlockRows<Real> A = view();
  A.end = diagonal_.data();  // the rows that follow are zero yet
  std::fill_n(x, 3 * point_.size(), Real(0));
  kernels_of<Real>().rows.relax(A, D.data(), true, b, x, work_.data());
}

template <class Real>
void CutMatrix<Real>::residual(const Real* b, const Real* x, int i, Real* r) const {
  const int n = row_[i];
  const Real* m = block_.data() + 9 * static_cast<std::size_t>(first_[n]);
  for (int a = 0; a < 3; ++a) r[a] = b[3 * i + a];
  for (int e = begin_[n]; e < begin_[n + 1]; ++e, m += 9) {
    const Real* v = x + 3 * column_[e];
    for (int a = 0; a < 3; ++a) r[a] -= m[3 * a] * v[0] + m[3 * a + 1] * v[1] + m[3 * a + 2] * v[2];
  }
}

template <class Real>
const Real* CutMatrix<Real>::block(int i, int j) const {
  const int n = row_[i];
  const auto row = column_.begin() + begin_[n], end = column_.begin() + begin_[n + 1];
  const auto at = std::lower_bound(row, end, row_[j], [&](int p, int of_j) { return row_[p] < of_j; });
  if (at == end || *at != j) return nullptr;
  return &block_[9 * static_cast<std::size_t>(first_[n] + (at - row))];
}

template <class Real>
Eigen::SparseMatrix<double> CutMatrix<Real>::sparse() const {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(9 * column_.size());
  for (int n = 0; n < rows(); ++n)
    for (int e = begin_[n]; e < begin_[n + 1]; ++e)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          entries.emplace_back(3 * point_[n] + a, 3 * column_[e] + b,
                               block_[9 * static_cast<std::size_t>(first_[n] + e - begin_[n]) + 3 * a + b]);
  Eigen::SparseMatrix<double> K(3 * rows(), 3 * rows());
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

template <class Real>
std::vector<Real> CutMatrix<Real>::inverse_diagonal(const std::vector<char>& fixed) const {
  std::vector<Real> all(9 * static_cast<std::size_t>(rows()), Real(0));
  for (int i = 0; i < rows(); ++i) {
    const Real* own = block(i, i);
    if (!own) continue;  // carried
    Eigen::Matrix3d D;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) D(a, b) = own[3 * a + b];
    const auto is_fixed = [&](int a) { return !fixed.empty() && fixed[3 * i + a]; };
    for (int a = 0; a < 3; ++a)
      if (is_fixed(a)) D(a, a) = 1;
    D = D.inverse().eval();
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        all[9 * static_cast<std::size_t>(i) + 3 * a + b] = is_fixed(a) ? Real(0) : static_cast<Real>(D(a, b));
  }
  return all;
}

template class CutMatrix<float>;
template class CutMatrix<double>;
template CutMatrix<float>::CutMatrix(const CutMatrix<double>&);

}  // namespace springproof
