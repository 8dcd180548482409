#include "meshes/surface/balanced.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "meshes/locate/facet_tree.h"
#include "meshes/surface/raised.h"

namespace springproof {
namespace {

constexpr int rounds = 3;
constexpr double least_cosine = 0.5;  // between a facet and the body's beside it: the other side of a sheet is none

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

/// Mean height of the body above a facet [m], exact for heights of second degree.
double height(const NearestPoint& body, const FacetTree& tree, const std::array<Vec3, 3>& x) {
  const Vec3 n = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
  const Vec3 middle = (x[0] + x[1] + x[2]) / 3;
  double sum = 0;
  for (const Vec3& corner : x) {
    const Vec3 p = (corner + middle) / 2;
    const auto [facet, point, distance] = tree.nearest(p);
    if (body.normals[facet].dot(n) > least_cosine) sum += (point - p).dot(n) / 3;
  }
  return sum;
}

}  // namespace

Surface balanced(const Surface& surface, const Surface& body) {
  const NearestPoint nearest(body);
  const FacetTree tree(nearest.mesh, nearest.facets);
  Surface moved = surface;
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> heights;
    for (const auto& t : moved.triangles)
      heights.push_back(height(nearest, tree, {moved.points[t[0]], moved.points[t[1]], moved.points[t[2]]}));
    moved = raised(moved, heights);
  }
  return moved;
}

}  // namespace springproof
