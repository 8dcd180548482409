#include "comparisons/judge/deformation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace springproof {
namespace {

/// Sign of a corner along an axis.
double sign(int corner, int axis) { return hexahedron_corners[corner][axis] ? 1 : -1; }

/// Of one cell: the patterns yz, zx, xy and xyz of its corners' displacements over its edge, and its Green strain.
struct CellStrain {
  Eigen::Matrix<double, 3, 4> hourglass = Eigen::Matrix<double, 3, 4>::Zero();
  Eigen::Matrix3d strain;
};

CellStrain strain_of(const Mesh& mesh, const Hexahedron& cell, const NodalVectors& u) {
  CellStrain s;
  Eigen::Matrix3d edges = Eigen::Matrix3d::Zero(), change = Eigen::Matrix3d::Zero();  // column: mean edge along an axis
  for (int n = 0; n < 8; ++n) {
    const Vec3 X = mesh.nodes.row(cell[n]), at = u.row(cell[n]);
    const double x = sign(n, 0), y = sign(n, 1), z = sign(n, 2);
    for (int axis = 0; axis < 3; ++axis) {
      edges.col(axis) += sign(n, axis) / 4 * X;
      change.col(axis) += sign(n, axis) / 4 * at;
    }
    s.hourglass.col(0) += y * z / 4 * at;
    s.hourglass.col(1) += z * x / 4 * at;
    s.hourglass.col(2) += x * y / 4 * at;
    s.hourglass.col(3) += x * y * z / 4 * at;
  }
  s.hourglass /= std::cbrt(std::abs(edges.determinant()));
  const Eigen::Matrix3d H = change * edges.inverse();
  s.strain = (H + H.transpose() + H.transpose() * H) / 2;
  return s;
}

/// A strain that the digits of positions hide: those of the node furthest from the origin, over a cell.  A step of a
/// motion rounds once; a thousand times that is left after a million steps.
double round_off_strain(const Mesh& mesh, const NodalVectors& u) {
  constexpr double steps = 1000;
  const Hexahedron& cell = mesh.hexahedra.front();
  const double edge = (mesh.nodes.row(cell[1]) - mesh.nodes.row(cell[0])).norm();
  const double reach = std::sqrt(mesh.nodes.rowwise().squaredNorm().maxCoeff()) + u.rowwise().norm().maxCoeff();
  return steps * std::numeric_limits<double>::epsilon() * reach / edge;
}

}  // namespace

Wrinkles wrinkles(const Mesh& mesh, const NodalVectors& displacement) {
  std::vector<CellStrain> cells;
  double all = 0, alternating = 0;
  for (const Hexahedron& cell : mesh.hexahedra) {
    cells.push_back(strain_of(mesh, cell, displacement));
    all += cells.back().strain.squaredNorm() + cells.back().hourglass.squaredNorm();
  }
  std::map<std::array<int, 4>, std::size_t> open;  // faces that one cell was seen at
  int pairs = 0;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (int f = 0; f < 6; ++f) {
      std::array<int, 4> face = face_of(mesh.hexahedra[c], f);
      std::ranges::sort(face);
      const auto [at, is_new] = open.try_emplace(face, c);
      if (is_new) continue;
      alternating += ((cells[c].hourglass - cells[at->second].hourglass) / 2).squaredNorm();
      ++pairs;
      open.erase(at);
    }
  if (pairs == 0) return {};
  const Wrinkles found = {std::sqrt(alternating / pairs), std::sqrt(all / static_cast<double>(cells.size()))};
  return found.strain > round_off_strain(mesh, displacement) ? found : Wrinkles{};
}

}  // namespace springproof
