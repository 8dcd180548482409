#include "meshes/locate/locate.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "meshes/box.h"
#include "meshes/locate/outer_facets.h"

namespace springproof {
namespace {

constexpr double cell_tolerance = 1e-9;  // of a cell

/// Shape functions and their derivatives, one row per corner.
struct Trilinear {
  Eigen::Matrix<double, 8, 1> shape;
  Eigen::Matrix<double, 8, 3> slope;
};

Trilinear trilinear(const Vec3& xi) {
  Trilinear at;
  for (int n = 0; n < 8; ++n) {
    double f[3], df[3];
    for (int d = 0; d < 3; ++d) {
      f[d] = hexahedron_corners[n][d] ? xi[d] : 1 - xi[d];
      df[d] = hexahedron_corners[n][d] ? 1 : -1;
    }
    at.shape[n] = f[0] * f[1] * f[2];
    at.slope.row(n) << df[0] * f[1] * f[2], f[0] * df[1] * f[2], f[0] * f[1] * df[2];
  }
  return at;
}

/// Corners relative to the point: far from the origin, coordinates themselves would lose digits.
Eigen::Matrix<double, 8, 3> corners_from(const Mesh& mesh, const Hexahedron& cell, const Vec3& point) {
  Eigen::Matrix<double, 8, 3> corners;
  for (int n = 0; n < 8; ++n) corners.row(n) = mesh.nodes.row(cell[n]) - point.transpose();
  return corners;
}

/// Newton's method for the trilinear coordinates of a point in or near a cell.
std::optional<Vec3> trilinear_coordinates(const Mesh& mesh, const Hexahedron& cell, const Vec3& point) {
  const Eigen::Matrix<double, 8, 3> corners = corners_from(mesh, cell, point);
  Vec3 xi(0.5, 0.5, 0.5);
  for (int iteration = 0; iteration < 30; ++iteration) {
    const Trilinear at = trilinear(xi);
    const Vec3 miss = corners.transpose() * at.shape;
    const Eigen::Matrix3d jacobian = corners.transpose() * at.slope;
    const Vec3 step = jacobian.partialPivLu().solve(-miss);
    xi += step;
    if (!(xi.norm() < 10)) return {};
    if (step.norm() <= 1e-13) return xi;
  }
  return {};
}

bool in_unit_cube(const Vec3& xi) {
  return (xi.array() >= -cell_tolerance).all() && (xi.array() <= 1 + cell_tolerance).all();
}

std::optional<Location> find_in_any(const Mesh& mesh, const Vec3& point) {
  for (std::size_t c = 0; c < mesh.hexahedra.size(); ++c) {
    Box box = empty_box();
    for (int n : mesh.hexahedra[c]) add_to(box, mesh.nodes.row(n).transpose());
    const double slack = cell_tolerance * (box.high - box.low).norm();
    if ((point.array() < box.low.array() - slack).any() || (point.array() > box.high.array() + slack).any()) continue;
    const auto xi = trilinear_coordinates(mesh, mesh.hexahedra[c], point);
    if (xi && in_unit_cube(*xi)) return Location{c, trilinear(*xi).shape};
  }
  return {};
}

/// Point of the cell's faces, each taken as two triangles, that is nearest.
Vec3 nearest_on_faces(const Mesh& mesh, const Hexahedron& cell, const Vec3& p) {
  Vec3 best = mesh.nodes.row(cell[0]).transpose();
  for (int f = 0; f < 6; ++f) {
    const auto n = face_of(cell, f);
    const auto x = [&](int corner) -> Vec3 { return mesh.nodes.row(n[corner]).transpose(); };
    for (const Vec3& q : {closest_point(p, x(0), x(1), x(2)), closest_point(p, x(0), x(2), x(3))})
      if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  }
  return best;
}

Location nearest_of_any(const Mesh& mesh, const Vec3& point) {
  std::size_t cell = 0;
  Vec3 foot = nearest_on_faces(mesh, mesh.hexahedra[0], point);
  for (std::size_t c = 1; c < mesh.hexahedra.size(); ++c) {
    const Vec3 q = nearest_on_faces(mesh, mesh.hexahedra[c], point);
    if ((q - point).squaredNorm() >= (foot - point).squaredNorm()) continue;
    cell = c;
    foot = q;
  }
  const Hexahedron& hexahedron = mesh.hexahedra[cell];
  const Trilinear at = trilinear(trilinear_coordinates(mesh, hexahedron, foot).value_or(Vec3::Constant(0.5)));
  const Eigen::Matrix<double, 8, 3> corners = corners_from(mesh, hexahedron, point);
  const Eigen::Matrix3d jacobian = corners.transpose() * at.slope;
  return {cell, at.shape - at.slope * jacobian.partialPivLu().solve(corners.transpose() * at.shape)};
}

Vec3 in_boxes(const Grid& grid, const Vec3& point) { return (point - grid.origin).cwiseQuotient(grid.spacing); }

/// Calls f(dx, dy, dz) for the boxes of a cubic shell.
template <class F>
void for_shell(int radius, F f) {
  for (int dz = -radius; dz <= radius; ++dz)
    for (int dy = -radius; dy <= radius; ++dy) {
      const bool whole_row = std::abs(dz) == radius || std::abs(dy) == radius;
      for (int dx = -radius; dx <= radius; dx += whole_row || radius == 0 ? 1 : 2 * radius) f(dx, dy, dz);
    }
}

}  // namespace

Locator::Locator(const Mesh& mesh) : mesh_(&mesh) {
  if (!mesh.grid) return;
  const auto& [nx, ny, nz] = mesh.grid->cells;
  cell_of_box_.assign(std::size_t(nx) * ny * nz, -1);
  for (std::size_t c = 0; c < mesh.grid->cell_index.size(); ++c) {
    const auto& [i, j, k] = mesh.grid->cell_index[c];
    cell_of_box_[(std::size_t(k) * ny + j) * nx + i] = static_cast<int>(c);
  }
}

int Locator::cell_at(int i, int j, int k) const {
  const auto& n = mesh_->grid->cells;
  if (i < 0 || j < 0 || k < 0 || i >= n[0] || j >= n[1] || k >= n[2]) return -1;
  return cell_of_box_[(std::size_t(k) * n[1] + j) * n[0] + i];
}

std::optional<Location> Locator::find_in_grid(const Vec3& point) const {
  const Grid& grid = *mesh_->grid;
  const Vec3 at = in_boxes(grid, point);
  int low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    if (!(at[axis] >= -1 && at[axis] <= grid.cells[axis] + 1)) return {};
    low[axis] = static_cast<int>(std::floor(at[axis] - cell_tolerance));
    high[axis] = static_cast<int>(std::floor(at[axis] + cell_tolerance));
  }
  int first = -1;
  for (int k = low[2]; k <= high[2]; ++k)
    for (int j = low[1]; j <= high[1]; ++j)
      for (int i = low[0]; i <= high[0]; ++i)
        if (const int cell = cell_at(i, j, k); cell >= 0 && (first < 0 || cell < first)) first = cell;
  if (first < 0) return {};
  const auto& [i, j, k] = grid.cell_index[first];
  return Location{static_cast<std::size_t>(first), trilinear(at - Vec3(i, j, k)).shape};
}

// In rings around the point of the grid's box that is nearest: of what ring r + 1 holds, nothing is nearer to that
// point than r boxes.
Location Locator::nearest_in_grid(const Vec3& point) const {
  const Grid& grid = *mesh_->grid;
  const Vec3 at = in_boxes(grid, point), count(grid.cells[0], grid.cells[1], grid.cells[2]);
  const Vec3 inside = at.cwiseMax(0).cwiseMin(count);
  const double off = (at - inside).cwiseProduct(grid.spacing).squaredNorm(), least_spacing = grid.spacing.minCoeff();
  const Vec3 home = inside.cwiseMin(count - Vec3::Ones()).array().floor();
  double least = std::numeric_limits<double>::infinity();
  int best = -1;
  Vec3 best_xi = Vec3::Zero();
  for (int radius = 0; off + std::pow(std::max(0, radius - 1) * least_spacing, 2) <= least; ++radius)
    for_shell(radius, [&](int dx, int dy, int dz) {
      const Vec3 box = home + Vec3(dx, dy, dz);
      const int cell = cell_at(int(box[0]), int(box[1]), int(box[2]));
      if (cell < 0) return;
      const Vec3 xi = at - box;
      const double distance = (xi - xi.cwiseMax(0).cwiseMin(1)).cwiseProduct(grid.spacing).squaredNorm();
      if (distance > least || (distance == least && cell > best)) return;
      least = distance;
      best = cell;
      best_xi = xi;
    });
  const Vec3 foot = best_xi.cwiseMax(0).cwiseMin(1);
  const Trilinear near = trilinear(foot);
  return {static_cast<std::size_t>(best), near.shape + near.slope * (best_xi - foot)};
}

std::optional<Location> Locator::find(const Vec3& point) const {
  return mesh_->grid ? find_in_grid(point) : find_in_any(*mesh_, point);
}

Location Locator::operator()(const Vec3& point) const {
  if (mesh_->hexahedra.empty()) throw std::invalid_argument("Locator: the mesh has no hexahedra");
  if (!point.allFinite()) throw std::invalid_argument("Locator: the point is not finite");
  if (const auto inside = find(point)) return *inside;
  return mesh_->grid ? nearest_in_grid(point) : nearest_of_any(*mesh_, point);
}

std::optional<Location> locate(const Mesh& mesh, const Vec3& point) { return Locator(mesh).find(point); }

Location nearest(const Mesh& mesh, const Vec3& point) { return Locator(mesh)(point); }

}  // namespace springproof
