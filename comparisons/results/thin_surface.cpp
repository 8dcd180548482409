#include "comparisons/results/thin_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace springproof {
namespace {

using Triangle = std::array<int, 3>;

std::vector<Triangle> triangles_of(const std::vector<std::array<int, 4>>& facets) {
  std::vector<Triangle> triangles;
  for (const auto& f : facets) {
    triangles.push_back({f[0], f[1], f[2]});
    if (f[3] >= 0) triangles.push_back({f[0], f[2], f[3]});
  }
  return triangles;
}

double area(const NodalVectors& points, const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const Vec3 ab = points.row(b) - points.row(a), ac = points.row(c) - points.row(a);
    sum += 0.5 * ab.cross(ac).norm();
  }
  return sum;
}

/// For each node the representative of its lattice cube, the node nearest to the mean of the cube's nodes; -1 for nodes
/// of no triangle.
std::vector<int> representatives(const NodalVectors& points, const std::vector<Triangle>& triangles, double edge) {
  std::map<std::array<long, 3>, std::vector<int>> cubes;
  std::vector<int> of(static_cast<std::size_t>(points.rows()), -1);
  for (const Triangle& t : triangles)
    for (int n : t) {
      if (of[n] >= 0) continue;
      of[n] = n;
      std::array<long, 3> cube;
      for (int d = 0; d < 3; ++d) cube[d] = std::lround(std::floor(points(n, d) / edge));
      cubes[cube].push_back(n);
    }
  for (const auto& [cube, nodes] : cubes) {
    Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
    for (int n : nodes) mean += points.row(n) / double(nodes.size());
    const int chosen = *std::min_element(nodes.begin(), nodes.end(), [&](int a, int b) {
      return (points.row(a) - mean).squaredNorm() < (points.row(b) - mean).squaredNorm();
    });
    for (int n : nodes) of[n] = chosen;
  }
  return of;
}

}  // namespace

std::vector<std::array<int, 4>> thinned(const NodalVectors& points, const std::vector<std::array<int, 4>>& facets,
                                        std::size_t most) {
  const std::vector<Triangle> triangles = triangles_of(facets);
  if (triangles.size() <= most) return facets;
  std::vector<std::array<int, 4>> kept;
  for (double edge = std::sqrt(2 * area(points, triangles) / double(most)); edge > 0; edge *= 1.1) {
    const std::vector<int> of = representatives(points, triangles, edge);
    std::set<Triangle> seen;
    kept.clear();
    for (const auto& [a, b, c] : triangles) {
      const Triangle t = {of[a], of[b], of[c]};
      Triangle key = t;
      std::sort(key.begin(), key.end());
      if (key[0] == key[1] || key[1] == key[2] || !seen.insert(key).second) continue;
      kept.push_back({t[0], t[1], t[2], -1});
    }
    if (kept.size() <= most) return kept;
  }
  return kept;
}

}  // namespace springproof
