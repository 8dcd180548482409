#include "meshes/quality.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace springproof {
namespace {

struct Shape {
  double radius_ratio, smallest_angle, edge_sum;
};

Shape shape_of(const std::array<Vec3, 4>& x) {
  const Vec3 a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
  // Outward area vectors of the faces opposite each corner, doubled.
  const std::array<Vec3, 4> face = {(x[2] - x[1]).cross(x[3] - x[1]), c.cross(b), a.cross(c), b.cross(a)};
  const double six_volumes = a.dot(b.cross(c));
  double areas = 0, edges = 0, largest_cosine = -1;
  for (const Vec3& f : face) areas += f.norm();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) {
      edges += (x[i] - x[j]).norm();
      largest_cosine = std::max(largest_cosine, -face[i].dot(face[j]) / (face[i].norm() * face[j].norm()));
    }
  const double inscribed = six_volumes / areas;
  const double circumscribed =
      (a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b)).norm() /
      (2 * six_volumes);
  return {3 * inscribed / circumscribed, std::acos(std::clamp(largest_cosine, -1.0, 1.0)) * 180 / std::numbers::pi,
          edges};
}

}  // namespace

double edge_of_regular(double volume, double tetrahedra) { return std::cbrt(6 * std::sqrt(2.0) * volume / tetrahedra); }

TetrahedraQuality quality_of(const Mesh& mesh) {
  TetrahedraQuality quality;
  quality.smallest_angle = 180;
  for (const Tetrahedron& cell : mesh.tetrahedra) {
    std::array<Vec3, 4> x;
    for (int c = 0; c < 4; ++c) x[c] = mesh.nodes.row(cell[c]);
    const Shape shape = shape_of(x);
    quality.mean_edge += shape.edge_sum / (6 * double(mesh.tetrahedra.size()));
    quality.smallest_angle = std::min(quality.smallest_angle, shape.smallest_angle);
    if (shape.radius_ratio >= quality.worst) continue;
    quality.worst = shape.radius_ratio;
    quality.at = (x[0] + x[1] + x[2] + x[3]) / 4;
  }
  return quality;
}

std::string words_for(const Mesh& mesh, const TetrahedraQuality& q) {
  return fmt::format(
      "{} tetrahedra, mean edge {:.3g} m; worst shape 3 r/R = {:.2g} near ({:.3g}, {:.3g}, {:.3g}) m, "
      "smallest angle between faces {:.2g} degrees",
      mesh.tetrahedra.size(), q.mean_edge, q.worst, q.at.x(), q.at.y(), q.at.z(), q.smallest_angle);
}

}  // namespace springproof
