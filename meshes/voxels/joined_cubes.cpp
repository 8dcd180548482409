#include "meshes/voxels/joined_cubes.h"

#include <algorithm>
#include <cstdlib>
#include <map>

#include "meshes/united_numbers.h"

namespace springproof {
namespace {

/// Corners of a cube whose average a place in its boundary is; a place that is a corner: that one; one off the lattice
/// of corners and their middles, or outside: none.
std::vector<int> corners_about(const LatticeCube& cube, const std::array<int, 3>& place) {
  std::vector<int> about;
  for (int n = 0; n < 8; ++n) {
    const std::array<int, 3> at = cube.corner(n);
    bool near = true;
    for (int d = 0; d < 3; ++d)
      near &= at[d] == place[d] || (2 * std::abs(at[d] - place[d]) == cube.size && place[d] > cube.at[d] &&
                                    place[d] < cube.at[d] + cube.size);
    if (near) about.push_back(n);
  }
  return about;
}

/// A corner of a cube in the boundary of a larger one.
struct Hanging {
  int corner;  ///< 8 * cube + n
  int on;      ///< the larger cube
};

}  // namespace

std::array<int, 3> LatticeCube::corner(int n) const {
  return {at[0] + size * hexahedron_corners[n][0], at[1] + size * hexahedron_corners[n][1],
          at[2] + size * hexahedron_corners[n][2]};
}

JoinedCubes join_cubes(const std::vector<LatticeCube>& cubes, const std::vector<std::array<int, 2>>& links) {
  UnitedNumbers corners(8 * cubes.size());
  std::vector<Hanging> hanging;
  for (const auto& [p, q] : links) {
    const auto [small, large] = cubes[p].size <= cubes[q].size ? std::array{p, q} : std::array{q, p};
    for (int n = 0; n < 8; ++n) {
      const std::vector<int> about = corners_about(cubes[large], cubes[small].corner(n));
      if (about.size() == 1)
        corners.unite(8 * small + n, 8 * large + about.front());
      else if (!about.empty())
        hanging.push_back({8 * small + n, large});
    }
  }

  // Two cubes that carry one point have the same corners about it.
  const auto place_of = [&](int corner) { return cubes[corner / 8].corner(corner % 8); };
  std::vector<int> carrier(8 * cubes.size());
  for (bool changed = true; changed;) {
    changed = false;
    std::fill(carrier.begin(), carrier.end(), -1);
    for (const Hanging& h : hanging) {
      int& first = carrier[corners.of(h.corner)];
      if (first < 0) {
        first = h.on;
        continue;
      }
      for (const int m : corners_about(cubes[first], place_of(h.corner)))
        for (const int n : corners_about(cubes[h.on], place_of(h.corner))) {
          const int a = 8 * first + m, b = 8 * h.on + n;
          if (place_of(a) != place_of(b) || corners.of(a) == corners.of(b)) continue;
          corners.unite(a, b);
          changed = true;
        }
    }
  }

  JoinedCubes out;
  std::vector<int> number(8 * cubes.size(), -1);
  out.corners.resize(cubes.size());
  for (int c = 0; c < static_cast<int>(8 * cubes.size()); ++c) {
    int& at = number[corners.of(c)];
    if (at < 0) {
      at = static_cast<int>(out.points.size());
      out.points.push_back(place_of(c));
    }
    out.corners[c / 8][c % 8] = at;
  }
  std::vector<std::pair<int, CarriedPoint>> by_size;
  for (int c = 0; c < static_cast<int>(8 * cubes.size()); ++c) {
    if (carrier[c] < 0 || corners.of(c) != c) continue;
    CarriedPoint point{number[c], {}};
    for (const int n : corners_about(cubes[carrier[c]], place_of(c))) point.by.push_back(out.corners[carrier[c]][n]);
    by_size.emplace_back(-cubes[carrier[c]].size, std::move(point));
  }
  std::stable_sort(by_size.begin(), by_size.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto& [size, point] : by_size) out.carried.push_back(std::move(point));
  return out;
}

Carriers carriers_of(int points, const std::vector<CarriedPoint>& carried) {
  if (carried.empty()) return {};
  Carriers all(points);
  for (const CarriedPoint& c : carried) {
    std::map<int, double> weight;
    for (const int p : c.by)
      if (all[p].empty())
        weight[p] += 1;
      else
        for (const auto& [q, w] : all[p]) weight[q] += w;
    for (const auto& [p, w] : weight) all[c.point].emplace_back(p, w / static_cast<double>(c.by.size()));
  }
  return all;
}

}  // namespace springproof
