#include "msm/topology/random/surface_features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "meshes/facets.h"

namespace springproof {
namespace {

const double cos_sharp = std::sqrt(3.0) / 2;  // 30 degrees

struct Side {
  std::array<int, 2> edge;  // points, ascending
  Vec3 normal;              // unit normal of the triangle
};

std::vector<Side> sides_of(const Region& region) {
  std::vector<Side> sides;
  for (const auto& t : region.surface_triangles) {
    const Vec3& a = region.surface_points[t[0]];
    const Vec3 normal = (region.surface_points[t[1]] - a).cross(region.surface_points[t[2]] - a).normalized();
    for (int c = 0; c < 3; ++c) sides.push_back({ascending(std::array{t[c], t[(c + 1) % 3]}), normal});
  }
  std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.edge < b.edge; });
  return sides;
}

bool is_corner(const std::vector<Vec3>& directions) {
  if (directions.empty()) return false;
  return directions.size() != 2 || -directions[0].dot(directions[1]) < cos_sharp;
}

}  // namespace

std::vector<std::array<int, 2>> sharp_edges(const Region& region) {
  const std::vector<Side> sides = sides_of(region);
  std::vector<std::array<int, 2>> sharp;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i;
    while (j < sides.size() && sides[j].edge == sides[i].edge) ++j;
    if (j != i + 2 || sides[i].normal.dot(sides[i + 1].normal) < cos_sharp) sharp.push_back(sides[i].edge);
    i = j;
  }
  return sharp;
}

SurfaceFeatures surface_features(const Region& region) {
  const auto& points = region.surface_points;
  SurfaceFeatures features;
  std::vector<std::vector<Vec3>> directions(points.size());
  for (const auto& [i, j] : sharp_edges(region)) {
    features.edges.push_back({points[i], points[j]});
    directions[i].push_back((points[j] - points[i]).normalized());
    directions[j].push_back((points[i] - points[j]).normalized());
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    if (is_corner(directions[i])) features.corners.push_back(points[i]);
  for (const auto& [a, b, c] : region.surface_triangles)
    features.triangles.push_back({points[a], points[b], points[c]});
  return features;
}

}  // namespace springproof
