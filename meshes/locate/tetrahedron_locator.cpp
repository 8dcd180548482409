#include "meshes/locate/tetrahedron_locator.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "meshes/box.h"
#include "meshes/locate/outer_facets.h"

namespace springproof {
namespace {

constexpr double weight_tolerance = 1e-9;  // of the weights: a point this far outside is inside

}  // namespace

TetrahedronLocator::TetrahedronLocator(const NodalVectors& X, const std::vector<Tetrahedron>& cells) {
  if (cells.empty()) throw std::invalid_argument("no tetrahedra to look for points in");
  Box all = empty_box();
  std::vector<Box> extents(cells.size(), all);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (const int n : cells[c]) add_to(extents[c], X.row(n).transpose());
    add_to(all, extents[c].low);
    add_to(all, extents[c].high);
    Cell cell;
    for (int i = 0; i < 4; ++i) cell.corners[i] = X.row(cells[c][i]).transpose();
    Eigen::Matrix3d edges;
    for (int i = 0; i < 3; ++i) edges.col(i) = cell.corners[i + 1] - cell.corners[0];
    cell.to_weights = edges.inverse();
    cells_.push_back(cell);
  }
  low_ = all.low;
  const Vec3 size = all.high - all.low;
  edge_ = std::max(std::cbrt(size.prod() / double(cells.size())), 1e-3 * size.maxCoeff());
  for (int d = 0; d < 3; ++d) count_[d] = static_cast<int>(size[d] / edge_) + 1;

  const auto visit = [&](const auto& act) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const auto from = box_of(extents[c].low), to = box_of(extents[c].high);
      for (int k = from[2]; k <= to[2]; ++k)
        for (int j = from[1]; j <= to[1]; ++j)
          for (int i = from[0]; i <= to[0]; ++i) act(c, (std::size_t(k) * count_[1] + j) * count_[0] + i);
    }
  };
  start_.assign(std::size_t(count_[0]) * count_[1] * count_[2] + 1, 0);
  visit([&](std::size_t, std::size_t box) { ++start_[box + 1]; });
  for (std::size_t b = 1; b < start_.size(); ++b) start_[b] += start_[b - 1];
  list_.resize(start_.back());
  std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
  visit([&](std::size_t c, std::size_t box) { list_[next[box]++] = static_cast<int>(c); });
}

std::array<int, 3> TetrahedronLocator::box_of(const Vec3& p) const {
  std::array<int, 3> box;
  for (int d = 0; d < 3; ++d)
    box[d] = static_cast<int>(std::clamp(std::floor((p[d] - low_[d]) / edge_), 0.0, count_[d] - 1.0));
  return box;
}

TetrahedronLocator::Place TetrahedronLocator::place_in(std::size_t c, const Vec3& p) const {
  const Cell& cell = cells_[c];
  const Vec3 w = cell.to_weights * (p - cell.corners[0]);
  Place place{c, {1 - w.sum(), w[0], w[1], w[2]}, 0};
  if (place.weights.minCoeff() >= -weight_tolerance) return place;
  place.outside = std::numeric_limits<double>::infinity();
  for (int across = 0; across < 4; ++across) {
    if (place.weights[across] >= 0) continue;
    const Vec3 &x = cell.corners[(across + 1) % 4], &y = cell.corners[(across + 2) % 4],
               &z = cell.corners[(across + 3) % 4];
    place.outside = std::min(place.outside, (closest_point(p, x, y, z) - p).norm());
  }
  return place;
}

TetrahedronLocator::Place TetrahedronLocator::operator()(const Vec3& p) const {
  const auto middle = box_of(p);
  Place best{0, Eigen::Vector4d::Zero(), std::numeric_limits<double>::infinity()};
  // Cells that reach into no box of the rings so far are at least (ring - 1) edges away.
  const int rings = *std::max_element(count_.begin(), count_.end());
  for (int ring = 0; ring < rings && best.outside > (ring - 1) * edge_; ++ring)
    for (int k = middle[2] - ring; k <= middle[2] + ring; ++k)
      for (int j = middle[1] - ring; j <= middle[1] + ring; ++j)
        for (int i = middle[0] - ring; i <= middle[0] + ring; ++i) {
          const bool on_ring =
              std::max({std::abs(i - middle[0]), std::abs(j - middle[1]), std::abs(k - middle[2])}) == ring;
          if (!on_ring || i < 0 || j < 0 || k < 0 || i >= count_[0] || j >= count_[1] || k >= count_[2]) continue;
          const std::size_t box = (std::size_t(k) * count_[1] + j) * count_[0] + i;
          for (std::size_t at = start_[box]; at < start_[box + 1]; ++at) {
            const Place here = place_in(list_[at], p);
            if (here.outside == 0) return here;
            if (here.outside < best.outside || (here.outside == best.outside && here.cell < best.cell)) best = here;
          }
        }
  return best;
}

}  // namespace springproof
