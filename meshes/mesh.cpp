#include "meshes/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "meshes/box.h"
#include "meshes/united_numbers.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

Vec3 node(const Mesh& mesh, int n) { return mesh.nodes.row(n).transpose(); }

/// Adds the integrals of the four bilinear shape functions over a quadrilateral, by 2 x 2 Gauss points.
void add_quadrilateral(const Mesh& mesh, const std::array<int, 4>& facet, Eigen::VectorXd& areas) {
  const Vec3 a = node(mesh, facet[0]), b = node(mesh, facet[1]), c = node(mesh, facet[2]), d = node(mesh, facet[3]);
  const double low = 0.5 - std::sqrt(3.0) / 6;
  for (const double s : {low, 1 - low})
    for (const double t : {low, 1 - low}) {
      const Vec3 along_s = (1 - t) * (b - a) + t * (c - d);
      const Vec3 along_t = (1 - s) * (d - a) + s * (c - b);
      const double weight = along_s.cross(along_t).norm() / 4;
      areas[facet[0]] += weight * (1 - s) * (1 - t);
      areas[facet[1]] += weight * s * (1 - t);
      areas[facet[2]] += weight * s * t;
      areas[facet[3]] += weight * (1 - s) * t;
    }
}

void add_triangle(const Mesh& mesh, const std::array<int, 4>& facet, Eigen::VectorXd& areas) {
  const Vec3 a = node(mesh, facet[0]);
  const double area = (node(mesh, facet[1]) - a).cross(node(mesh, facet[2]) - a).norm() / 2;
  for (int i = 0; i < 3; ++i) areas[facet[i]] += area / 3;
}

/// Number of lattice steps from origin to x if x is a lattice point within the tolerance.
std::optional<int> lattice_step(double x, double origin, double spacing, double tolerance) {
  const double step = std::round((x - origin) / spacing);
  if (!(std::abs(step) < 1e9) || std::abs(x - (origin + step * spacing)) > tolerance) return std::nullopt;
  return static_cast<int>(step);
}

/// Lattice through the bounding box with the first cell's proportions, or nothing if it does not divide the
/// box.
std::optional<Grid> lattice_of(const Mesh& mesh) {
  Grid grid;
  const Hexahedron& first = mesh.hexahedra.front();
  Box box = empty_box();
  for (const Hexahedron& hexahedron : mesh.hexahedra)
    for (const int n : hexahedron) add_to(box, node(mesh, n));
  const Vec3 first_cell = node(mesh, first[6]) - node(mesh, first[0]);
  for (int c = 0; c < 3; ++c) {
    const double extent = box.high[c] - box.low[c];
    const double count = std::round(extent / first_cell[c]);
    if (!(count >= 1 && count < 1e6)) return std::nullopt;
    grid.cells[c] = static_cast<int>(count);
    grid.spacing[c] = extent / count;
  }
  grid.origin = box.low;
  return grid;
}

/// Cell index of a box whose corner 0 is its lowest, or nothing.
std::optional<std::array<int, 3>> index_in(const Grid& grid, const Mesh& mesh, const Hexahedron& hexahedron) {
  std::array<int, 3> index{};
  for (int c = 0; c < 3; ++c) {
    const double tolerance = 1e-9 * grid.cells[c] * grid.spacing[c];
    for (int corner = 0; corner < 8; ++corner) {
      const double x = mesh.nodes(hexahedron[corner], c);
      const auto step = lattice_step(x, grid.origin[c], grid.spacing[c], tolerance);
      if (!step) return std::nullopt;
      if (corner == 0) index[c] = *step;
      if (*step != index[c] + hexahedron_corners[corner][c]) return std::nullopt;
    }
  }
  return index;
}

bool all_different(std::vector<std::int64_t> keys) {
  std::sort(keys.begin(), keys.end());
  return std::adjacent_find(keys.begin(), keys.end()) == keys.end();
}

/// One cell per lattice box, one mesh node per lattice point: what a grid promises to structured kernels.
bool is_one_to_one(const Grid& grid, const Mesh& mesh) {
  auto key = [&](int i, int j, int k) { return (std::int64_t{k} * (grid.cells[1] + 1) + j) * (grid.cells[0] + 1) + i; };
  std::vector<std::int64_t> cells, points;
  std::vector<bool> seen(mesh.nodes.rows(), false);
  for (std::size_t h = 0; h < mesh.hexahedra.size(); ++h) {
    const auto [i, j, k] = grid.cell_index[h];
    cells.push_back(key(i, j, k));
    for (int corner = 0; corner < 8; ++corner) {
      const int n = mesh.hexahedra[h][corner];
      const auto [di, dj, dk] = hexahedron_corners[corner];
      if (!seen[n]) points.push_back(key(i + di, j + dj, k + dk));
      seen[n] = true;
    }
  }
  return all_different(std::move(cells)) && all_different(std::move(points));
}

}  // namespace

const Patch& patch(const Mesh& mesh, const std::string& name) {
  std::string known;
  for (const Patch& p : mesh.patches) {
    if (p.name == name) return p;
    known += (known.empty() ? "" : ", ") + p.name;
  }
  throw std::invalid_argument("no patch '" + name + "' (the body has: " + (known.empty() ? "none" : known) + ")");
}

std::vector<int> nodes_of(const Patch& patch) {
  std::vector<int> nodes;
  for (const auto& facet : patch.facets)
    for (const int n : facet)
      if (n >= 0) nodes.push_back(n);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

Eigen::VectorXd nodal_areas(const Mesh& mesh, const Patch& patch) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.nodes.rows());
  for (const auto& facet : patch.facets) {
    if (facet[3] < 0)
      add_triangle(mesh, facet, areas);
    else
      add_quadrilateral(mesh, facet, areas);
  }
  return areas;
}

// Exact: the position is interpolated by the very shape functions that the areas integrate.
Vec3 centroid(const Mesh& mesh, const Patch& patch) {
  const Eigen::VectorXd areas = nodal_areas(mesh, patch);
  return mesh.nodes.transpose() * areas / areas.sum();
}

Eigen::VectorXd nodal_volumes(const Mesh& mesh) {
  const Eigen::VectorXd cells = cell_volumes(mesh, mesh.nodes);
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(mesh.nodes.rows());
  Eigen::Index cell = 0;
  for (const Hexahedron& hexahedron : mesh.hexahedra) {
    for (const int n : hexahedron) shares[n] += cells[cell] / 8;
    ++cell;
  }
  for (const Tetrahedron& tetrahedron : mesh.tetrahedra) {
    for (const int n : tetrahedron) shares[n] += cells[cell] / 4;
    ++cell;
  }
  return shares;
}

int separate_parts(const Mesh& mesh) {
  UnitedNumbers parts(static_cast<std::size_t>(mesh.nodes.rows()));
  std::vector<char> used(static_cast<std::size_t>(mesh.nodes.rows()), 0);
  const auto join = [&](const auto& cell) {
    for (const int n : cell) {
      used[n] = 1;
      parts.unite(n, cell[0]);
    }
  };
  for (const Hexahedron& cell : mesh.hexahedra) join(cell);
  for (const Tetrahedron& cell : mesh.tetrahedra) join(cell);
  int count = 0;
  for (int n = 0; n < static_cast<int>(used.size()); ++n) count += used[n] && parts.of(n) == n;
  return count;
}

std::optional<Grid> detect_grid(const Mesh& mesh) {
  if (mesh.hexahedra.empty() || !mesh.tetrahedra.empty()) return std::nullopt;
  std::optional<Grid> grid = lattice_of(mesh);
  if (!grid) return std::nullopt;
  grid->cell_index.reserve(mesh.hexahedra.size());
  for (const Hexahedron& hexahedron : mesh.hexahedra) {
    const auto index = index_in(*grid, mesh, hexahedron);
    if (!index) return std::nullopt;
    grid->cell_index.push_back(*index);
  }
  if (!is_one_to_one(*grid, mesh)) return std::nullopt;
  return grid;
}

Mesh block_mesh(const Vec3& size, const std::array<int, 3>& cells) {
  if (!(size.minCoeff() > 0) || !size.allFinite()) throw std::invalid_argument("block_mesh: size must be positive");
  if (*std::min_element(cells.begin(), cells.end()) < 1)
    throw std::invalid_argument("block_mesh: at least one cell along each side");
  const auto [nx, ny, nz] = cells;
  Mesh mesh;
  mesh.nodes.resize(Eigen::Index{nx + 1} * (ny + 1) * (nz + 1), 3);
  Eigen::Index n = 0;
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) mesh.nodes.row(n++) << size.x() * i / nx, size.y() * j / ny, size.z() * k / nz;

  Grid grid{cells, Vec3::Zero(), size.cwiseQuotient(Vec3(nx, ny, nz)), {}};
  for (const char* name : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"}) mesh.patches.push_back({name, {}});
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        Hexahedron hexahedron;
        for (int corner = 0; corner < 8; ++corner) {
          const auto& offset = hexahedron_corners[corner];
          hexahedron[corner] = ((k + offset[2]) * (ny + 1) + j + offset[1]) * (nx + 1) + i + offset[0];
        }
        mesh.hexahedra.push_back(hexahedron);
        grid.cell_index.push_back({i, j, k});
        const std::array<bool, 6> on_surface = {i == 0, i == nx - 1, j == 0, j == ny - 1, k == 0, k == nz - 1};
        for (int f = 0; f < 6; ++f)
          if (on_surface[f]) mesh.patches[f].facets.push_back(face_of(hexahedron, f));
      }
  mesh.grid = std::move(grid);
  return mesh;
}

}  // namespace springproof
