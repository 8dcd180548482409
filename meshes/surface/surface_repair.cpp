#include "meshes/surface/surface_repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "meshes/facets.h"

namespace springproof {
namespace {

using Triangle = std::array<int, 3>;

/// Points by the cubes of a lattice, some tolerances wide: the ball about a point rarely reaches into a second cube.
class PointGrid {
 public:
  PointGrid(std::vector<Vec3>& points, double tolerance) : points_(points), tolerance_(tolerance) {}

  /// Number of the point at p or up to the tolerance away, else of p, now added.
  int number_of(const Vec3& p) {
    const Key low = key(p - Vec3::Constant(tolerance_)), high = key(p + Vec3::Constant(tolerance_));
    for (std::int64_t x = low.x; x <= high.x; ++x)
      for (std::int64_t y = low.y; y <= high.y; ++y)
        for (std::int64_t z = low.z; z <= high.z; ++z)
          if (const auto cube = first_.find({x, y, z}); cube != first_.end())
            for (int i = cube->second; i >= 0; i = next_[i])
              if ((points_[i] - p).squaredNorm() <= tolerance_ * tolerance_) return i;
    const int added = static_cast<int>(points_.size());
    points_.push_back(p);
    const auto [cube, is_new] = first_.try_emplace(key(p), added);
    next_.push_back(is_new ? -1 : std::exchange(cube->second, added));
    return added;
  }

 private:
  struct Key {
    std::int64_t x, y, z;
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Key& k) const {
      std::uint64_t h = 0;
      for (const std::int64_t c : {k.x, k.y, k.z}) {
        h = (h ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15u;
        h ^= h >> 29;
      }
      return h;
    }
  };
  Key key(const Vec3& p) const {
    const Vec3 cube = (p / (16 * tolerance_)).array().floor();
    return {static_cast<std::int64_t>(cube.x()), static_cast<std::int64_t>(cube.y()),
            static_cast<std::int64_t>(cube.z())};
  }

  std::vector<Vec3>& points_;
  double tolerance_;
  std::unordered_map<Key, int, Hash> first_;
  std::vector<int> next_;  ///< in the same cube
};

/// Numbers of facets with the same corners as one before them.
std::vector<bool> repeated(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<Triangle, int>> sorted;
  sorted.reserve(triangles.size());
  for (std::size_t f = 0; f < triangles.size(); ++f) sorted.emplace_back(ascending(triangles[f]), static_cast<int>(f));
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> again(triangles.size(), false);
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first) again[sorted[i].second] = true;
  return again;
}

void leave_out_unused_points(Surface& surface) {
  std::vector<int> number(surface.points.size(), -1);
  std::vector<Vec3> used;
  for (Triangle& triangle : surface.triangles)
    for (int& p : triangle) {
      if (number[p] < 0) {
        number[p] = static_cast<int>(used.size());
        used.push_back(surface.points[p]);
      }
      p = number[p];
    }
  surface.points = std::move(used);
}

}  // namespace

Welded weld(const Surface& raw, double tolerance) {
  Welded result;
  PointGrid grid(result.surface.points, tolerance);
  std::vector<Triangle> triangles;
  triangles.reserve(raw.triangles.size());
  for (const Triangle& corners : raw.triangles) {
    const Triangle t = {grid.number_of(raw.points[corners[0]]), grid.number_of(raw.points[corners[1]]),
                        grid.number_of(raw.points[corners[2]])};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
      result.without_area.push_back(raw.points[corners[0]]);
    else
      triangles.push_back(t);
  }
  const std::vector<bool> again = repeated(triangles);
  for (std::size_t f = 0; f < triangles.size(); ++f)
    if (again[f])
      result.twice.push_back(result.surface.points[triangles[f][0]]);
    else
      result.surface.triangles.push_back(triangles[f]);
  leave_out_unused_points(result.surface);
  return result;
}

std::optional<std::vector<int>> orient(Surface& surface, const std::vector<Side>& sides, const Neighbours& neighbours) {
  std::vector<std::array<bool, 3>> agrees(neighbours.size());
  bool possible = true;
  for_each_edge(sides, [&](std::span<const Side> pair) {
    const auto starts_low = [&](const Side& s) { return surface.triangles[s.facet][s.corner] == s.low; };
    const bool opposite = starts_low(pair[0]) != starts_low(pair[1]);
    for (const Side& side : pair) agrees[side.facet][side.corner] = opposite;
  });
  enum : char { unknown, as_is, turned };
  std::vector<char> state(neighbours.size(), unknown);
  std::vector<int> shell, all_turned;  // shell: its facets so far, and those whose neighbours are still to be seen
  for (std::size_t first = 0; first < neighbours.size(); ++first) {
    if (state[first] != unknown) continue;
    shell.assign(1, static_cast<int>(first));
    state[first] = as_is;
    for (std::size_t i = 0; i < shell.size(); ++i)
      for (int side = 0; side < 3; ++side) {
        const int facet = shell[i], next = neighbours[facet][side];
        const char wanted = (state[facet] == as_is) == agrees[facet][side] ? as_is : turned;
        if (state[next] == unknown) {
          state[next] = wanted;
          shell.push_back(next);
        }
        possible &= state[next] == wanted;
      }
    const auto count = std::count_if(shell.begin(), shell.end(), [&](int f) { return state[f] == turned; });
    const char fewer = 2 * count <= static_cast<std::ptrdiff_t>(shell.size()) ? turned : as_is;
    for (const int facet : shell)
      if (state[facet] == fewer) all_turned.push_back(facet);
  }
  if (!possible) return std::nullopt;
  for (const int facet : all_turned) std::swap(surface.triangles[facet][1], surface.triangles[facet][2]);
  return all_turned;
}

void turn_inside_out(Surface& surface) {
  for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
}

namespace {

/// The side of the facet that its third corner is lower than `height` above, if any.
std::optional<int> base_of_flat(const Surface& surface, int facet, double height) {
  const Triangle& t = surface.triangles[facet];
  std::array<double, 3> length{};
  for (int i = 0; i < 3; ++i) length[i] = (surface.points[t[(i + 1) % 3]] - surface.points[t[i]]).norm();
  const Vec3 two_areas =
      (surface.points[t[1]] - surface.points[t[0]]).cross(surface.points[t[2]] - surface.points[t[0]]);
  const auto longest = std::max_element(length.begin(), length.end());
  if (two_areas.norm() > height * *longest) return std::nullopt;
  return static_cast<int>(longest - length.begin());
}

int side_towards(const Neighbours& neighbours, int facet, int other) {
  const auto& sides = neighbours[facet];
  return static_cast<int>(std::find(sides.begin(), sides.end(), other) - sides.begin());
}

/// Whether an edge joins corner i of the facet with the point, by a walk round the corner.
bool are_joined(const Surface& surface, const Neighbours& neighbours, int facet, int corner, int point) {
  const int centre = surface.triangles[facet][corner];
  int at = facet, i = corner;
  do {
    if (surface.triangles[at][(i + 1) % 3] == point || surface.triangles[at][(i + 2) % 3] == point) return true;
    at = neighbours[at][i];
    const Triangle& t = surface.triangles[at];
    i = static_cast<int>(std::find(t.begin(), t.end(), centre) - t.begin());
  } while (at != facet);
  return false;
}

/// Facets abc and bad become cad and dbc, unless there is an edge cd already.
bool flip(Surface& surface, Neighbours& neighbours, int facet, int side) {
  const int other = neighbours[facet][side];
  const int j = side_towards(neighbours, other, facet);
  const Triangle f = surface.triangles[facet], g = surface.triangles[other];
  const int a = f[side], b = f[(side + 1) % 3], c = f[(side + 2) % 3], d = g[(j + 2) % 3];
  if (g[j] != b || are_joined(surface, neighbours, facet, (side + 2) % 3, d)) return false;
  const int bc = neighbours[facet][(side + 1) % 3], ca = neighbours[facet][(side + 2) % 3];
  const int ad = neighbours[other][(j + 1) % 3], db = neighbours[other][(j + 2) % 3];
  neighbours[ad][side_towards(neighbours, ad, other)] = facet;
  neighbours[bc][side_towards(neighbours, bc, facet)] = other;
  surface.triangles[facet] = {c, a, d};
  neighbours[facet] = {ca, ad, other};
  surface.triangles[other] = {d, b, c};
  neighbours[other] = {db, bc, facet};
  return true;
}

}  // namespace

Flattened remove_flat_facets(Surface& surface, Neighbours& neighbours, double height) {
  Flattened result;
  std::vector<int> waiting;
  const int facets = static_cast<int>(surface.triangles.size());
  for (int f = 0; f < facets; ++f)
    if (base_of_flat(surface, f, height)) waiting.push_back(f);
  std::size_t flips_left = 20 * waiting.size();  // two flat facets may pass an edge to and fro
  while (!waiting.empty() && flips_left-- > 0) {
    const int facet = waiting.back();
    waiting.pop_back();
    const std::optional<int> base = base_of_flat(surface, facet, height);
    if (!base) continue;
    const Vec3 place = surface.points[surface.triangles[facet][(*base + 2) % 3]];
    const int other = neighbours[facet][*base];
    if (!flip(surface, neighbours, facet, *base)) continue;
    result.removed.push_back(place);
    waiting.push_back(facet);
    waiting.push_back(other);
  }
  for (int f = 0; f < facets; ++f)
    if (base_of_flat(surface, f, height)) result.left.push_back(surface.points[surface.triangles[f][0]]);
  return result;
}

}  // namespace springproof
