#include "meshes/surface/surface.h"

#include <Eigen/Geometry>

#include "meshes/facets.h"

namespace springproof {

Surface outside_of(const Mesh& mesh, const std::vector<OuterFacet>& facets) {
  Surface surface;
  for (const auto& X : mesh.nodes.rowwise()) surface.points.push_back(X.transpose());
  for (const OuterFacet& f : facets) {
    surface.triangles.push_back({f.nodes[0], f.nodes[1], f.nodes[2]});
    if (f.nodes[3] >= 0) surface.triangles.push_back({f.nodes[0], f.nodes[2], f.nodes[3]});
  }
  return surface;
}

double volume(const Surface& surface) {
  if (surface.triangles.empty()) return 0;
  const Vec3 origin = surface.points[surface.triangles[0][0]];  // near the body: no cancellation far from zero
  double six_volumes = 0;
  for (const auto& [a, b, c] : surface.triangles)
    six_volumes += (surface.points[a] - origin).dot((surface.points[b] - origin).cross(surface.points[c] - origin));
  return six_volumes / 6;
}

Vec3 centroid(const Surface& surface) {
  if (surface.triangles.empty()) return Vec3::Zero();
  const Vec3 origin = surface.points[surface.triangles[0][0]];
  Vec3 moment = Vec3::Zero();
  for (const auto& [i, j, k] : surface.triangles) {
    const Vec3 a = surface.points[i] - origin, b = surface.points[j] - origin, c = surface.points[k] - origin;
    moment += a.dot(b.cross(c)) / 6 * (a + b + c) / 4;
  }
  return origin + moment / volume(surface);
}

double area(const Surface& surface) {
  double two_areas = 0;
  for (const auto& [a, b, c] : surface.triangles)
    two_areas += (surface.points[b] - surface.points[a]).cross(surface.points[c] - surface.points[a]).norm();
  return two_areas / 2;
}

Box bounding_box(const Surface& surface) {
  Box box = empty_box();
  for (const auto& triangle : surface.triangles)
    for (const int p : triangle) add_to(box, surface.points[p]);
  return box;
}

}  // namespace springproof
