#include "msm/topology/region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "meshes/locate/outer_facets.h"
#include "meshes/volume.h"
#include "msm/topology/point_cells.h"
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

using Points = std::vector<Vec3>;
using Triangles = std::vector<std::array<int, 3>>;

void icosahedron(Points& points, Triangles& triangles) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  for (const double s : {-1.0, 1.0})
    for (const double t : {-g, g}) {
      points.emplace_back(0, s, t);
      points.emplace_back(s, t, 0);
      points.emplace_back(t, 0, s);
    }
  for (int a = 0; a < 12; ++a)  // neighbours are 2 apart, all others more
    for (int b = a + 1; b < 12; ++b)
      for (int c = b + 1; c < 12; ++c) {
        const Vec3 ab = points[b] - points[a], ac = points[c] - points[a], bc = points[c] - points[b];
        if (std::max({ab.squaredNorm(), ac.squaredNorm(), bc.squaredNorm()}) > 5) continue;
        if (ab.cross(ac).dot(points[a]) > 0)
          triangles.push_back({a, b, c});
        else
          triangles.push_back({a, c, b});
      }
  for (Vec3& p : points) p /= p.norm();
}

void subdivide(Points& points, Triangles& triangles) {
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
    if (is_new) {
      const Vec3 p = points[a] + points[b];
      points.push_back(p / p.norm());
    }
    return entry->second;
  };
  Triangles finer;
  for (const auto& [a, b, c] : triangles) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  triangles = std::move(finer);
}

}  // namespace

Region region_of(const Mesh& mesh) {
  if (mesh.hexahedra.empty() && mesh.tetrahedra.empty()) throw std::invalid_argument("the mesh has no cells to fill");
  Region region;
  add_surface(mesh, region);
  region.lower = region.upper = region.surface_points.front();
  for (const Vec3& p : region.surface_points) {
    region.lower = region.lower.cwiseMin(p);
    region.upper = region.upper.cwiseMax(p);
  }
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

Region ball(const Vec3& centre, double radius) {
  if (!(radius > 0)) throw std::invalid_argument("ball: the radius must be positive");
  Region region;
  icosahedron(region.surface_points, region.surface_triangles);
  for (int level = 0; level < 5; ++level) subdivide(region.surface_points, region.surface_triangles);
  for (Vec3& p : region.surface_points) p = centre + radius * p;
  region.lower = centre - Vec3::Constant(radius);
  region.upper = centre + Vec3::Constant(radius);
  region.volume = 4 * std::numbers::pi / 3 * radius * radius * radius;
  const double reach = radius + boundary_tolerance * region.size();
  region.inside = [centre, reach](const Vec3& p) { return (p - centre).squaredNorm() <= reach * reach; };
  return region;
}

std::vector<char> near_surface(const Region& region, const std::vector<Vec3>& points, double distance) {
  PointCells cells(region.lower, region.upper, std::max(1.5 * distance, region.size() / 300), false);
  for (const Vec3& p : points) cells.add(p);
  std::vector<char> near(points.size(), 0);
  for (const auto& t : region.surface_triangles)
    for_pieces(region.surface_points[t[0]], region.surface_points[t[1]], region.surface_points[t[2]], distance / 2,
               [&](const Vec3& a, const Vec3& b, const Vec3& c) {
                 cells.any_near((a + b + c) / 3, [&](int p) {
                   near[p] = near[p] || (closest_point(points[p], a, b, c) - points[p]).norm() < distance;
                   return false;
                 });
               });
  return near;
}

}  // namespace springproof
