#include "meshes/surface/surface_topology.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "meshes/facets.h"

namespace springproof {

std::vector<Side> sides_by_edge(const Surface& surface) {
  std::vector<Side> sides;
  sides.reserve(3 * surface.triangles.size());
  for (std::size_t f = 0; f < surface.triangles.size(); ++f)
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(surface.triangles[f][i], surface.triangles[f][(i + 1) % 3]);
      sides.push_back({low, high, static_cast<int>(f), i});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.facet) < std::tie(b.low, b.high, b.facet);
  });
  return sides;
}

Neighbours neighbours_of(const std::vector<Side>& sides, std::size_t facets) {
  Neighbours neighbours(facets);
  for_each_edge(sides, [&](std::span<const Side> pair) {
    neighbours[pair[0].facet][pair[0].corner] = pair[1].facet;
    neighbours[pair[1].facet][pair[1].corner] = pair[0].facet;
  });
  return neighbours;
}

std::vector<int> shells(const Neighbours& neighbours) {
  std::vector<int> shell(neighbours.size(), -1), front;
  int count = 0;
  for (std::size_t first = 0; first < neighbours.size(); ++first) {
    if (shell[first] >= 0) continue;
    shell[first] = count;
    front.push_back(static_cast<int>(first));
    while (!front.empty()) {
      const int facet = front.back();
      front.pop_back();
      for (const int next : neighbours[facet])
        if (shell[next] < 0) {
          shell[next] = count;
          front.push_back(next);
        }
    }
    ++count;
  }
  return shell;
}

std::vector<Hole> holes(const Surface& surface, const std::vector<Side>& sides) {
  UnitedNumbers sets(surface.points.size());
  std::vector<Side> open;
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() != 1) return;
    open.push_back(edge[0]);
    sets.unite(edge[0].low, edge[0].high);
  });
  std::vector<int> hole_of(surface.points.size(), -1);
  std::vector<Hole> found;
  for (const Side& side : open) {
    int& hole = hole_of[sets.of(side.low)];
    if (hole < 0) {
      hole = static_cast<int>(found.size());
      found.push_back({0, surface.points[side.low], empty_box()});
    }
    ++found[hole].edges;
    for (const int p : {side.low, side.high}) add_to(found[hole].box, surface.points[p]);
  }
  return found;
}

std::vector<int> pinched_points(const Surface& surface, const Neighbours& neighbours) {
  UnitedNumbers corners(3 * neighbours.size());  // joined round their point, across edges
  const auto corner_at = [&](int facet, int point) {
    const auto& triangle = surface.triangles[facet];
    return 3 * facet + static_cast<int>(std::find(triangle.begin(), triangle.end(), point) - triangle.begin());
  };
  for (int f = 0; f < static_cast<int>(neighbours.size()); ++f)
    for (int i = 0; i < 3; ++i) {
      const int next = neighbours[f][i], from = surface.triangles[f][i], to = surface.triangles[f][(i + 1) % 3];
      if (next < f) continue;
      corners.unite(3 * f + i, corner_at(next, from));
      corners.unite(3 * f + (i + 1) % 3, corner_at(next, to));
    }
  std::vector<int> fan(surface.points.size(), -1), pinched;
  for (int c = 0; c < 3 * static_cast<int>(neighbours.size()); ++c) {
    int& first = fan[surface.triangles[c / 3][c % 3]];
    if (first < 0)
      first = corners.of(c);
    else if (first != corners.of(c))
      pinched.push_back(surface.triangles[c / 3][c % 3]);
  }
  std::sort(pinched.begin(), pinched.end());
  pinched.erase(std::unique(pinched.begin(), pinched.end()), pinched.end());
  return pinched;
}

double winding_number(const Surface& surface, const Vec3& point) {
  double solid_angle = 0;  // van Oosterom & Strackee (1983)
  for (const auto& triangle : surface.triangles) {
    const Vec3 a = surface.points[triangle[0]] - point, b = surface.points[triangle[1]] - point,
               c = surface.points[triangle[2]] - point;
    const double p = a.norm(), q = b.norm(), r = c.norm();
    solid_angle += 2 * std::atan2(a.dot(b.cross(c)), p * q * r + a.dot(b) * r + b.dot(c) * p + c.dot(a) * q);
  }
  return solid_angle / (4 * std::numbers::pi);
}

}  // namespace springproof
