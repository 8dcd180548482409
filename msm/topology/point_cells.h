// Cell list that finds the points near a position in constant time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "problem/vector.h"

namespace springproof {

struct PointCells {
  Vec3 lower, size;          ///< box [m]
  bool periodic;             ///< the box repeats along every axis
  std::array<int, 3> count;  ///< cells along each axis, none narrower than the edge asked for
  std::vector<int> first;    ///< first point of each cell, -1: empty
  std::vector<int> next;     ///< point in the same cell, -1: last

  /// A periodic box needs three cells along each axis, or a neighbour would be visited twice.
  PointCells(const Vec3& low, const Vec3& high, double edge, bool repeats)
      : lower(low), size(high - low), periodic(repeats) {
    for (int a = 0; a < 3; ++a) count[a] = static_cast<int>(std::clamp(std::floor(size[a] / edge), 1.0, 1e6));
    if (periodic && *std::min_element(count.begin(), count.end()) < 3)
      throw std::invalid_argument("a periodic box must be at least three times as wide as the longest spring");
    if (double(count[0]) * count[1] * count[2] > 1e9)
      throw std::invalid_argument("the nodes are too small for the body");
    first.assign(std::size_t(count[0]) * count[1] * count[2], -1);
  }

  int cell_along(int axis, double x) const {
    return static_cast<int>(
        std::clamp(std::floor((x - lower[axis]) / size[axis] * count[axis]), 0.0, count[axis] - 1.0));
  }
  std::size_t number(int i, int j, int k) const { return (std::size_t(k) * count[1] + j) * count[0] + i; }

  /// Points are numbered in the order in which they are added.
  void add(const Vec3& x) {
    int& head = first[number(cell_along(0, x[0]), cell_along(1, x[1]), cell_along(2, x[2]))];
    next.push_back(head);
    head = static_cast<int>(next.size()) - 1;
  }

  /// Difference of two positions, between nearest images if the box is periodic [m].
  Vec3 nearest_image(Vec3 d) const {
    if (periodic)
      for (int a = 0; a < 3; ++a) {
        if (d[a] > size[a] / 2)
          d[a] -= size[a];
        else if (d[a] < -size[a] / 2)
          d[a] += size[a];
      }
    return d;
  }

  /// f(point) for all points in the cells within `rings` of x's, until one returns true.
  template <class F>
  bool any_near(const Vec3& x, F f, int rings = 1) const {
    int low[3], high[3];
    for (int a = 0; a < 3; ++a) {
      const int c = cell_along(a, x[a]);
      low[a] = periodic ? c - rings : std::max(0, c - rings);
      high[a] = periodic ? std::min(c + rings, c - rings + count[a] - 1) : std::min(count[a] - 1, c + rings);
    }
    const auto wrap = [&](int i, int a) { return i < 0 ? i + count[a] : i >= count[a] ? i - count[a] : i; };
    for (int k = low[2]; k <= high[2]; ++k)
      for (int j = low[1]; j <= high[1]; ++j)
        for (int i = low[0]; i <= high[0]; ++i)
          for (int p = first[number(wrap(i, 0), wrap(j, 1), wrap(k, 2))]; p >= 0; p = next[p])
            if (f(p)) return true;
    return false;
  }

  /// f(point) for all of them.
  template <class F>
  void for_near(const Vec3& x, int rings, F f) const {
    const auto go_on = [&](int p) {
      f(p);
      return false;
    };
    any_near(x, go_on, rings);
  }
};

}  // namespace springproof
