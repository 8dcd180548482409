#include "msm/topology/region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "meshes/box.h"
#include "meshes/volume.h"
#include "msm/topology/ray_parity.h"

namespace springproof {
namespace {

constexpr double boundary_tolerance = 1e-12;  // of the size of the body

/// Triangles of the outer facets, pointing away from their cell, and the points they use.
void add_surface(const Mesh& mesh, Region& region) {
  std::vector<int> number(mesh.nodes.rows(), -1);
  const auto point = [&](int n) {
    if (number[n] < 0) {
      number[n] = static_cast<int>(region.surface_points.size());
      region.surface_points.push_back(mesh.nodes.row(n).transpose());
    }
    return number[n];
  };
  const auto add_triangle = [&](int a, int b, int c, const Vec3& behind) {
    std::array<int, 3> t = {point(a), point(b), point(c)};
    const Vec3& x = region.surface_points[t[0]];
    const Vec3 normal = (region.surface_points[t[1]] - x).cross(region.surface_points[t[2]] - x);
    if (normal.dot(x - behind) < 0) std::swap(t[1], t[2]);
    region.surface_triangles.push_back(t);
  };
  for (const OuterFacet& f : outer_facets(mesh)) {
    add_triangle(f.nodes[0], f.nodes[1], f.nodes[2], f.cell_centre);
    if (f.nodes[3] >= 0) add_triangle(f.nodes[0], f.nodes[2], f.nodes[3], f.cell_centre);
  }
  for (const Patch& p : mesh.patches) {
    region.patches.push_back({p.name, {}});
    for (const auto& f : p.facets)
      region.patches.back().facets.push_back({point(f[0]), point(f[1]), point(f[2]), f[3] < 0 ? -1 : point(f[3])});
  }
}

std::function<bool(const Vec3&)> inside_grid(const Grid& grid, double tolerance) {
  const auto number = [count = grid.cells](int i, int j, int k) {
    return (std::size_t(k) * count[1] + j) * count[0] + i;
  };
  auto filled = std::make_shared<std::vector<char>>(std::size_t(grid.cells[0]) * grid.cells[1] * grid.cells[2], 0);
  for (const auto& [i, j, k] : grid.cell_index) (*filled)[number(i, j, k)] = 1;
  return [filled, number, count = grid.cells, origin = grid.origin, spacing = grid.spacing, tolerance](const Vec3& p) {
    int low[3], high[3];
    for (int a = 0; a < 3; ++a) {
      const double below = std::floor((p[a] - tolerance - origin[a]) / spacing[a]);
      const double above = std::floor((p[a] + tolerance - origin[a]) / spacing[a]);
      if (!(above >= 0 && below < count[a])) return false;
      low[a] = static_cast<int>(std::max(below, 0.0));
      high[a] = static_cast<int>(std::min(above, count[a] - 1.0));
    }
    for (int k = low[2]; k <= high[2]; ++k)
      for (int j = low[1]; j <= high[1]; ++j)
        for (int i = low[0]; i <= high[0]; ++i)
          if ((*filled)[number(i, j, k)]) return true;
    return false;
  };
}

}  // namespace

Region region_of(const Mesh& mesh) {
  if (mesh.hexahedra.empty() && mesh.tetrahedra.empty()) throw std::invalid_argument("the mesh has no cells to fill");
  Region region;
  add_surface(mesh, region);
  const Box box = box_of(region.surface_points);
  region.lower = box.low;
  region.upper = box.high;
  region.volume = volume(mesh, mesh.nodes);
  const double tolerance = boundary_tolerance * region.size();
  if (mesh.grid) {
    region.inside = inside_grid(*mesh.grid, tolerance);
  } else {
    const auto surface =
        std::make_shared<const RayParity>(ray_parity(region.surface_points, region.surface_triangles, tolerance));
    region.inside = [surface](const Vec3& p) { return surface->inside(p); };
  }
  return region;
}

}  // namespace springproof
