#include "meshes/volume.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <tuple>

namespace springproof {
namespace {

template <int corners>
using Corners = Eigen::Matrix<double, corners, 3>;

template <class Cell>
auto corners_of(const Cell& cell, const NodalVectors& x) {
  Corners<std::tuple_size_v<Cell>> corners;
  for (std::size_t i = 0; i < cell.size(); ++i) corners.row(i) = x.row(cell[i]);
  return corners;
}

/// dV/dx of a trilinear hexahedron, one row per corner.  A bilinear face encloses the mean of the volumes
/// that its two triangulations do: face abcd adds ([abc] + [acd] + [abd] + [bcd]) / 12 to the volume.
Corners<8> volume_gradient(const Corners<8>& x) {
  const Corners<8> y = x.rowwise() - x.row(0);
  Corners<8> gradient = Corners<8>::Zero();
  for (const auto& face : hexahedron_faces)
    for (int i = 0; i < 4; ++i) {
      const Vec3 next = y.row(face[(i + 1) % 4]), across = y.row(face[(i + 2) % 4]), last = y.row(face[(i + 3) % 4]);
      gradient.row(face[i]) += (next.cross(across) + across.cross(last) + next.cross(last)) / 12;
    }
  return gradient;
}

Corners<4> volume_gradient(const Corners<4>& x) {
  const Vec3 a = x.row(1) - x.row(0), b = x.row(2) - x.row(0), c = x.row(3) - x.row(0);
  Corners<4> gradient;
  gradient.row(1) = b.cross(c) / 6;
  gradient.row(2) = c.cross(a) / 6;
  gradient.row(3) = a.cross(b) / 6;
  gradient.row(0) = -(gradient.row(1) + gradient.row(2) + gradient.row(3));
  return gradient;
}

/// det(dx/dxi) at each corner of the reference cube.
std::array<double, 8> corner_determinants(const Corners<8>& x) {
  // The three neighbours of each corner along the reference axes.
  constexpr std::array<std::array<int, 3>, 8> neighbours = {
      {{1, 3, 4}, {0, 2, 5}, {3, 1, 6}, {2, 0, 7}, {5, 7, 0}, {4, 6, 1}, {7, 5, 2}, {6, 4, 3}}};
  std::array<double, 8> determinants;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Matrix3d J;
    for (int axis = 0; axis < 3; ++axis) {
      const double direction = hexahedron_corners[corner][axis] == 0 ? 1 : -1;
      J.row(axis) = direction * (x.row(neighbours[corner][axis]) - x.row(corner));
    }
    determinants[corner] = J.determinant();
  }
  return determinants;
}

std::array<double, 1> corner_determinants(const Corners<4>& x) { return {6 * tetrahedron_volume(x)}; }

/// Calls f(cell) for every hexahedron, then every tetrahedron.
template <class Function>
void for_each_cell(const Mesh& mesh, Function&& f) {
  for (const Hexahedron& cell : mesh.hexahedra) f(cell);
  for (const Tetrahedron& cell : mesh.tetrahedra) f(cell);
}

}  // namespace

double hexahedron_volume(const Eigen::Matrix<double, 8, 3>& x) {
  return volume_gradient(x).cwiseProduct(x.rowwise() - x.row(0)).sum() / 3;
}

double tetrahedron_volume(const Eigen::Matrix<double, 4, 3>& x) {
  const Vec3 a = x.row(1) - x.row(0), b = x.row(2) - x.row(0), c = x.row(3) - x.row(0);
  return a.dot(b.cross(c)) / 6;
}

Eigen::VectorXd cell_volumes(const Mesh& mesh, const NodalVectors& x) {
  Eigen::VectorXd volumes(mesh.hexahedra.size() + mesh.tetrahedra.size());
  Eigen::Index i = 0;
  for (const Hexahedron& cell : mesh.hexahedra) volumes[i++] = hexahedron_volume(corners_of(cell, x));
  for (const Tetrahedron& cell : mesh.tetrahedra) volumes[i++] = tetrahedron_volume(corners_of(cell, x));
  return volumes;
}

double volume(const Mesh& mesh, const NodalVectors& x) { return cell_volumes(mesh, x).sum(); }

// V' - V as the integral of u . dV/dx along X + t u: quadratic in t, so Simpson's rule is exact, and a small
// displacement keeps its digits, which subtracting the volumes would lose.
double volume_change(const Mesh& mesh, const NodalVectors& displacement) {
  double change = 0;
  for_each_cell(mesh, [&](const auto& cell) {
    const auto X = corners_of(cell, mesh.nodes);
    const auto u = corners_of(cell, displacement);
    auto gradient = volume_gradient(X);
    gradient += 4 * volume_gradient((X + u / 2).eval());
    gradient += volume_gradient((X + u).eval());
    change += gradient.cwiseProduct(u).sum() / 6;
  });
  return change / volume(mesh, mesh.nodes);
}

double volume_change_first_order(const Mesh& mesh, const NodalVectors& displacement) {
  double change = 0;
  for_each_cell(mesh, [&](const auto& cell) {
    change += volume_gradient(corners_of(cell, mesh.nodes)).cwiseProduct(corners_of(cell, displacement)).sum();
  });
  return change / volume(mesh, mesh.nodes);
}

NodalVectors volume_gradient(const Mesh& mesh) {
  NodalVectors gradient = NodalVectors::Zero(mesh.nodes.rows(), 3);
  for_each_cell(mesh, [&](const auto& cell) {
    const auto own = volume_gradient(corners_of(cell, mesh.nodes));
    for (std::size_t n = 0; n < cell.size(); ++n) gradient.row(cell[n]) += own.row(static_cast<Eigen::Index>(n));
  });
  return gradient;
}

std::array<double, 8> corner_jacobians(const Hexahedron& cell, const NodalVectors& x) {
  return corner_determinants(corners_of(cell, x));
}

double min_relative_jacobian(const Mesh& mesh, const NodalVectors& x) {
  double smallest = std::numeric_limits<double>::infinity();
  for_each_cell(mesh, [&](const auto& cell) {
    const auto rest = corner_determinants(corners_of(cell, mesh.nodes));
    const auto now = corner_determinants(corners_of(cell, x));
    for (std::size_t i = 0; i < rest.size(); ++i) smallest = std::min(smallest, now[i] / rest[i]);
  });
  return smallest;
}

}  // namespace springproof
