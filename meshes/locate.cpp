#include "meshes/locate.h"

#include <Eigen/LU>

namespace springproof {
namespace {

/// Newton's method for the trilinear coordinates of a point in a cell.
std::optional<Eigen::Matrix<double, 8, 1>> shape_functions(const Mesh& mesh, const Hexahedron& cell,
                                                           const Vec3& point) {
  Eigen::Matrix<double, 8, 1> shape;
  Vec3 xi(0.5, 0.5, 0.5);
  for (int iteration = 0; iteration < 30; ++iteration) {
    Vec3 miss =
        Vec3::Zero();  // from the point: far from the origin, coordinates themselves would lose digits
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
    for (int n = 0; n < 8; ++n) {
      double f[3], df[3];
      for (int d = 0; d < 3; ++d) {
        f[d] = hexahedron_corners[n][d] ? xi[d] : 1 - xi[d];
        df[d] = hexahedron_corners[n][d] ? 1 : -1;
      }
      const Vec3 p = mesh.nodes.row(cell[n]).transpose() - point;
      shape[n] = f[0] * f[1] * f[2];
      miss += shape[n] * p;
      jacobian += p * Eigen::RowVector3d(df[0] * f[1] * f[2], f[0] * df[1] * f[2], f[0] * f[1] * df[2]);
    }
    const Vec3 step = jacobian.partialPivLu().solve(-miss);
    xi += step;
    if (!(xi.norm() < 10)) return {};
    if (step.norm() > 1e-13) continue;
    if ((xi.array() < -1e-9).any() || (xi.array() > 1 + 1e-9).any()) return {};
    return shape;
  }
  return {};
}

}  // namespace

std::optional<Location> locate(const Mesh& mesh, const Vec3& point) {
  for (std::size_t c = 0; c < mesh.hexahedra.size(); ++c) {
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (int n : mesh.hexahedra[c]) {
      low = low.cwiseMin(mesh.nodes.row(n).transpose());
      high = high.cwiseMax(mesh.nodes.row(n).transpose());
    }
    const double slack = 1e-9 * (high - low).norm();
    if ((point.array() < low.array() - slack).any() || (point.array() > high.array() + slack).any()) continue;
    if (const auto shape = shape_functions(mesh, mesh.hexahedra[c], point)) return Location{c, *shape};
  }
  return {};
}

}  // namespace springproof
