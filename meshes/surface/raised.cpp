#include "meshes/surface/raised.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace springproof {
namespace {

constexpr double farthest = 0.25;  // a point moves, in edges of a facet at it
constexpr double regular = 1e-3;   // share of the motion that no facet demands
constexpr double level = 1e-6;     // of its edge: a facet of less height lies in a plane of the body
constexpr double stiff = 1e6;      // weight of such a facet's demand over others'

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
    longest = std::max(longest, farthest * edge);
  }
  Vec3 motion() const {
    if (!(areas > 0)) return Vec3::Zero();
    const Eigen::Matrix3d m = matrix + regular * areas * Eigen::Matrix3d::Identity();
    const Vec3 d = m.ldlt().solve(sum);
    return d.norm() > longest ? Vec3(d * longest / d.norm()) : d;
  }
};

}  // namespace

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

}  // namespace springproof
