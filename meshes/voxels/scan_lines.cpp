#include "meshes/voxels/scan_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace springproof {
namespace {

constexpr double on_lattice = 1e-9;  // coordinates that are off a lattice plane by no more are on it

/// A place on the plane z = k.
struct Place {
  double x, y;
};

struct Crossing {
  int row;
  double x;
};

double snapped(double x) {
  const double nearest = std::round(x);
  return std::abs(x - nearest) <= on_lattice ? nearest : x;
}

/// Lattice planes c with low <= c < high, cut to 0 <= c < n.
std::pair<int, int> planes_between(double low, double high, int n) {
  const double last = n;
  return {static_cast<int>(std::clamp(std::ceil(low), 0.0, last)),
          static_cast<int>(std::clamp(std::ceil(high), 0.0, last))};
}

/// Where the edge meets the plane.  It is taken from its lower point number to the higher: all its triangles get the
/// same place to the last bit, so that what the plane cuts out of a closed surface are closed polygons.
Place cut(const std::vector<Vec3>& points, int i, int j, double z) {
  if (i > j) std::swap(i, j);
  const Vec3 &a = points[i], &b = points[j];
  const double t = (z - a.z()) / (b.z() - a.z());
  return {snapped(a.x() + t * (b.x() - a.x())), snapped(a.y() + t * (b.y() - a.y()))};
}

/// The lines y = j that a side of a polygon crosses, ends counted half open: of a closed polygon each line crosses an
/// even number.
void add_side(const Place& p, const Place& q, int k, const std::array<int, 3>& n, std::vector<Crossing>& crossings) {
  const auto [begin, end] = planes_between(std::min(p.y, q.y), std::max(p.y, q.y), n[1]);
  for (int j = begin; j < end; ++j) {
    const double x = p.x + (j - p.y) / (q.y - p.y) * (q.x - p.x);
    crossings.push_back({k * n[1] + j, snapped(std::clamp(x, std::min(p.x, q.x), std::max(p.x, q.x)))});
  }
}

void add_triangle(const std::vector<Vec3>& points, const std::array<int, 3>& t, const std::array<int, 3>& n,
                  std::vector<Crossing>& crossings) {
  const double z[] = {points[t[0]].z(), points[t[1]].z(), points[t[2]].z()};
  const auto [begin, end] = planes_between(*std::min_element(z, z + 3), *std::max_element(z, z + 3), n[2]);
  for (int k = begin; k < end; ++k) {
    Place ends[2];
    int count = 0;  // two of the three edges reach through the plane
    for (int e = 0; e < 3; ++e)
      if ((z[e] <= k) != (z[(e + 1) % 3] <= k)) ends[count++] = cut(points, t[e], t[(e + 1) % 3], k);
    add_side(ends[0], ends[1], k, n, crossings);
  }
}

}  // namespace

std::vector<RowRun> runs_inside(const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles,
                                const std::array<int, 3>& n) {
  std::vector<Vec3> on_planes = points;
  for (Vec3& p : on_planes) p = p.unaryExpr(&snapped);
  std::vector<Crossing> crossings;
  for (const auto& t : triangles) add_triangle(on_planes, t, n, crossings);
  std::sort(crossings.begin(), crossings.end(),
            [](const Crossing& a, const Crossing& b) { return a.row != b.row ? a.row < b.row : a.x < b.x; });
  std::vector<RowRun> runs;
  for (std::size_t c = 0; c + 1 < crossings.size(); c += 2) {
    const auto [begin, end] = planes_between(crossings[c].x, crossings[c + 1].x, n[0]);
    const int row = crossings[c].row;
    if (begin == end) continue;
    if (!runs.empty() && runs.back().row == row && runs.back().end == begin)
      runs.back().end = end;
    else
      runs.push_back({row, begin, end});
  }
  return runs;
}

}  // namespace springproof
