#include "meshes/surface/balanced.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "meshes/locate/facet_tree.h"

namespace springproof {
namespace {

constexpr double most_motion = 0.25;  // a point moves, in edges of a facet at it
constexpr double regular = 1e-3;      // share of the motion that no facet demands
constexpr double level = 1e-6;        // of its edge: a facet of less height lies in a plane of the body
constexpr double stiff = 1e6;         // weight of such a facet's demand over others'

/// What the facets at a point demand of its motion d: sum A (n.d - s)^2.
struct Demand {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Vec3 sum = Vec3::Zero();
  double areas = 0, longest = 0;  ///< [m^2], [m]

  void add(double area, const Vec3& n, double s, double edge) {
    const double weight = (std::abs(s) < level * edge ? stiff : 1) * area;
    matrix += weight * n * n.transpose();
    sum += weight * s * n;
    areas += area;
    longest = std::max(longest, most_motion * edge);
  }
  Vec3 motion() const {
    if (!(areas > 0)) return Vec3::Zero();
    const Eigen::Matrix3d m = matrix + regular * areas * Eigen::Matrix3d::Identity();
    const Vec3 d = m.ldlt().solve(sum);
    return d.norm() > longest ? Vec3(d * longest / d.norm()) : d;
  }
};

/// The surface with its points moved so that each facet rises by its height [m] along its normal, as nearly as the
/// facets at a point agree (least squares by area): plane faces of height 0 and creases between them stay.
Surface raised(const Surface& surface, const std::vector<double>& heights) {
  std::vector<Demand> demands(surface.points.size());
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    const auto& t = surface.triangles[f];
    const Vec3& x = surface.points[t[0]];
    const Vec3 normal = (surface.points[t[1]] - x).cross(surface.points[t[2]] - x);
    const double area = normal.norm() / 2;
    if (!(area > 0)) continue;
    for (const int p : t) demands[p].add(area, normal.normalized(), heights[f], std::sqrt(2 * area));
  }
  Surface moved = surface;
  for (std::size_t p = 0; p < moved.points.size(); ++p) moved.points[p] += demands[p].motion();
  return moved;
}

constexpr int rounds = 3;
constexpr double least_cosine = 0.5;  // between a facet and the body's beside it: the other side of a sheet is none

Vec3 normal_of(const Surface& s, const std::array<int, 3>& t) {
  return (s.points[t[1]] - s.points[t[0]]).cross(s.points[t[2]] - s.points[t[0]]).normalized();
}

/// Mean height of the body above a facet [m], exact for heights of second degree.
double height(const Surface& body, const FacetTree& tree, const std::array<Vec3, 3>& x) {
  const Vec3 n = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
  const Vec3 middle = (x[0] + x[1] + x[2]) / 3;
  double sum = 0;
  for (const Vec3& corner : x) {
    const Vec3 p = (corner + middle) / 2;
    const auto [facet, point, distance] = tree.nearest(p);
    if (normal_of(body, body.triangles[facet]).dot(n) > least_cosine) sum += (point - p).dot(n) / 3;
  }
  return sum;
}

}  // namespace

Surface balanced(const Surface& surface, const Surface& body) {
  const FacetTree tree(body.points, body.triangles);
  Surface moved = surface;
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> heights;
    for (const auto& t : moved.triangles)
      heights.push_back(height(body, tree, {moved.points[t[0]], moved.points[t[1]], moved.points[t[2]]}));
    moved = raised(moved, heights);
  }
  return moved;
}

Surface balanced(const Surface& surface, const std::vector<double>& heights) {
  Surface moved = surface;
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> left = heights;
    for (std::size_t f = 0; f < left.size(); ++f) {
      const auto& t = surface.triangles[f];
      const Vec3 n = normal_of(surface, t);
      for (const int p : t) left[f] -= (moved.points[p] - surface.points[p]).dot(n) / 3;
    }
    moved = raised(moved, left);
  }
  return moved;
}

}  // namespace springproof
