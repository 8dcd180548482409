#include "meshes/surface/balanced.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "meshes/locate/facet_tree.h"

namespace springproof {
namespace {

constexpr int rounds = 2;
constexpr double farthest = 0.25;     // a point moves, in edges of a facet at it
constexpr double least_cosine = 0.5;  // between a facet and the body's beside it: the other side of a sheet is none
constexpr double regular = 1e-3;      // share of the motion that no facet demands

/// The body's surface, to find the nearest point of it.
struct NearestPoint {
  Mesh mesh;
  std::vector<OuterFacet> facets;
  std::vector<Vec3> normals;

  explicit NearestPoint(const Surface& body) {
    mesh.nodes.resize(static_cast<Eigen::Index>(body.points.size()), 3);
    for (std::size_t n = 0; n < body.points.size(); ++n)
      mesh.nodes.row(static_cast<Eigen::Index>(n)) = body.points[n].transpose();
    for (const auto& [a, b, c] : body.triangles) {
      std::array<int, 4> key = {-1, a, b, c};
      std::sort(key.begin(), key.end());
      facets.push_back({key, {a, b, c, -1}, Vec3::Zero()});
      normals.push_back((body.points[b] - body.points[a]).cross(body.points[c] - body.points[a]).normalized());
    }
  }
};

/// Mean height of the body above a facet of normal n [m]: at the middles of four equal parts of it.
double height(const NearestPoint& body, const FacetTree& tree, const std::array<Vec3, 3>& x, const Vec3& n) {
  const Vec3 middle = (x[0] + x[1] + x[2]) / 3;
  double sum = 0;
  for (const Vec3& p : {middle, Vec3((x[0] + middle) / 2), Vec3((x[1] + middle) / 2), Vec3((x[2] + middle) / 2)}) {
    const auto [facet, point, distance] = tree.nearest(p);
    if (body.normals[facet].dot(n) > least_cosine) sum += (point - p).dot(n) / 4;
  }
  return sum;
}

/// What the facets at a point demand of its motion d: sum A (n.d - s)^2.
struct Demand {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Vec3 sum = Vec3::Zero();
  double longest = 0;  ///< [m]

  void add(double area, const Vec3& n, double s, double edge) {
    matrix += area * n * n.transpose();
    sum += area * s * n;
    longest = std::max(longest, farthest * edge);
  }
  Vec3 motion() const {
    if (!(matrix.trace() > 0)) return Vec3::Zero();
    const Eigen::Matrix3d m = matrix + regular * matrix.trace() * Eigen::Matrix3d::Identity();
    const Vec3 d = m.ldlt().solve(sum);
    return d.norm() > longest ? Vec3(d * longest / d.norm()) : d;
  }
};

}  // namespace

Surface balanced(const Surface& surface, const Surface& body) {
  const NearestPoint nearest(body);
  const FacetTree tree(nearest.mesh, nearest.facets);
  Surface moved = surface;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Demand> demands(moved.points.size());
    for (const auto& t : moved.triangles) {
      const std::array<Vec3, 3> x = {moved.points[t[0]], moved.points[t[1]], moved.points[t[2]]};
      const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
      const double area = normal.norm() / 2;
      if (!(area > 0)) continue;
      const Vec3 n = normal.normalized();
      const double s = height(nearest, tree, x, n), edge = std::sqrt(2 * area);
      for (const int p : t) demands[p].add(area, n, s, edge);
    }
    for (std::size_t p = 0; p < moved.points.size(); ++p) moved.points[p] += demands[p].motion();
  }
  return moved;
}

}  // namespace springproof
