// Random sequential addition (Kot et al. 2014, sec. 3.3), exact up to jamming.
#pragma once

#include <functional>
#include <random>

#include "msm/topology/point_cells.h"

namespace springproof {

/// Points no two of which are closer than min_distance, and the generator that draws more.
struct Sample {
  PointCells cells;
  double min_distance;     ///< minL [m]
  std::mt19937_64 random;  ///< the standard fixes its bits; its distributions depend on the library and are not used
  std::vector<Vec3> points;

  Sample(const Vec3& lower, const Vec3& upper, double distance, bool periodic, std::uint64_t seed)
      : cells(lower, upper, distance, periodic), min_distance(distance), random(seed) {}

  bool is_free(const Vec3& x) const;
  void add(const Vec3& x);
};

/// Uniform in [0, 1), from the upper 53 bits.
double uniform(std::mt19937_64& random);

// Each adds points, uniform over the space that the present points leave free, until `wanted` are added or nothing is
// left free, and returns how many it added.  Method: parts of the domain that one exclusion ball covers are dropped,
// points are drawn in the rest, which is subdivided when few draws succeed.  So jamming is detected, in O(N).
// Uncovered parts below 2^-16 of the first ones are treated as covered.

/// In a box; `inside` (empty: everywhere) determines where points may lie.  Parts with corners and centre outside are
/// dropped.
int fill_box(Sample& sample, const Vec3& lower, const Vec3& upper, const std::function<bool(const Vec3&)>& inside,
             long wanted);
int fill_triangles(Sample& sample, const std::vector<std::array<Vec3, 3>>& triangles, long wanted);
int fill_edges(Sample& sample, const std::vector<std::array<Vec3, 2>>& edges, long wanted);

}  // namespace springproof
