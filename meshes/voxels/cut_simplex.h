// Cuts tetrahedra and triangles by the planes of a lattice of unit cubes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "meshes/voxels/voxelise.h"
#include "problem/vector.h"

namespace springproof {

using TetrahedronCorners = std::array<Vec3, 4>;
using TriangleCorners = std::array<Vec3, 3>;

/// Corners within this distance of a plane lie on it, in edges of the cubes.
inline constexpr double lattice_tolerance = 1e-9;

/// Where the line through a and b has coordinate `at` of an axis.
inline Vec3 cut_point(const Vec3& a, const Vec3& b, int axis, double at) {
  Vec3 p = a + (at - a[axis]) / (b[axis] - a[axis]) * (b - a);
  p[axis] = at;
  return p;
}

/// Cuts a simplex at coordinate `at` of an axis; calls below(part) and above(part) for simplices that make it up.
template <class Below, class Above>
void cut_at(const TetrahedronCorners& t, int axis, double at, const Below& below, const Above& above) {
  std::array<Vec3, 4> x = t;
  std::sort(x.begin(), x.end(), [&](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
  const auto on = [&](const Vec3& a, const Vec3& b) { return cut_point(a, b, axis, at); };
  const auto wedge = [](const TriangleCorners& a, const TriangleCorners& b, const auto& act) {
    act(TetrahedronCorners{a[0], a[1], a[2], b[2]});
    act(TetrahedronCorners{a[0], a[1], b[1], b[2]});
    act(TetrahedronCorners{a[0], b[0], b[1], b[2]});
  };
  int low = 0;
  while (low < 4 && x[low][axis] < at - lattice_tolerance) ++low;
  int not_high = low;
  while (not_high < 4 && x[not_high][axis] <= at + lattice_tolerance) ++not_high;
  if (low == 0) return above(t);
  if (not_high == 4) return below(t);
  if (low == 1) {
    const auto meet = [&](int i) { return i < not_high ? x[i] : on(x[0], x[i]); };
    const TriangleCorners p = {meet(1), meet(2), meet(3)};
    below(TetrahedronCorners{x[0], p[0], p[1], p[2]});
    wedge(p, {x[1], x[2], x[3]}, above);
  } else if (low == 2) {
    const Vec3 p02 = not_high > 2 ? x[2] : on(x[0], x[2]), p12 = not_high > 2 ? x[2] : on(x[1], x[2]);
    const Vec3 p03 = on(x[0], x[3]), p13 = on(x[1], x[3]);
    wedge({x[0], p02, p03}, {x[1], p12, p13}, below);
    wedge({x[2], p02, p12}, {x[3], p03, p13}, above);
  } else {
    const TriangleCorners p = {on(x[0], x[3]), on(x[1], x[3]), on(x[2], x[3])};
    wedge(p, {x[0], x[1], x[2]}, below);
    above(TetrahedronCorners{x[3], p[0], p[1], p[2]});
  }
}

template <class Below, class Above>
void cut_at(const TriangleCorners& t, int axis, double at, const Below& below, const Above& above) {
  int alone = 0;  // the corner that lies on one side alone; the order of the corners is kept
  std::array<int, 3> side;
  for (int i = 0; i < 3; ++i)
    side[i] = t[i][axis] < at - lattice_tolerance ? -1 : t[i][axis] > at + lattice_tolerance ? 1 : 0;
  const int low = *std::min_element(side.begin(), side.end()), high = *std::max_element(side.begin(), side.end());
  if (low >= 0) return above(t);
  if (high <= 0) return below(t);
  const auto on = [&](const Vec3& a, const Vec3& b) { return cut_point(a, b, axis, at); };
  const auto emit = [&](const TriangleCorners& part, int where) { where < 0 ? below(part) : above(part); };
  for (int i = 0; i < 3; ++i)
    if (side[i] == 0) {  // through a corner
      const Vec3 &a = t[i], &b = t[(i + 1) % 3], &c = t[(i + 2) % 3], p = on(b, c);
      emit({a, b, p}, side[(i + 1) % 3]);
      emit({a, p, c}, side[(i + 2) % 3]);
      return;
    }
  while (side[alone] == side[(alone + 1) % 3] || side[alone] == side[(alone + 2) % 3]) ++alone;
  const Vec3 &a = t[alone], &b = t[(alone + 1) % 3], &c = t[(alone + 2) % 3], ab = on(a, b), ac = on(a, c);
  emit({a, ab, ac}, side[alone]);
  emit({ab, b, c}, -side[alone]);
  emit({ab, c, ac}, -side[alone]);
}

/// Calls act(cube, part) for parts of a simplex, each within one cube.
template <class Simplex, class Act>
void cut_by_lattice(const Simplex& s, const std::array<int, 3>& cells, const Act& act, int axis = 0,
                    std::array<int, 3> cube = {}) {
  if (axis == 3) return act(cube, s);
  double low = s[0][axis], high = low;
  for (const Vec3& x : s) {
    low = std::min(low, x[axis]);
    high = std::max(high, x[axis]);
  }
  const int first = std::clamp(static_cast<int>(std::floor(low + lattice_tolerance)), 0, cells[axis] - 1);
  const int last = std::clamp(static_cast<int>(std::ceil(high - lattice_tolerance)) - 1, first, cells[axis] - 1);
  if (first == last) {
    cube[axis] = first;
    return cut_by_lattice(s, cells, act, axis + 1, cube);
  }
  const auto further = [&](const Simplex& part) { cut_by_lattice(part, cells, act, axis, cube); };
  cut_at(s, axis, (first + last + 1) / 2, further, further);
}

/// The same for the cells of a grid, which may be of several sizes; act(lowest cube of a cell, part).
template <class Simplex, class Act>
void cut_by_cells(const Simplex& s, const VoxelGrid& grid, const Act& act, std::array<int, 3> at = {}, int size = 0) {
  if (grid.doubled.empty()) return cut_by_lattice(s, grid.cells, act);
  if (size == 0)
    for (size = 1; size < *std::max_element(grid.cells.begin(), grid.cells.end());) size *= 2;
  if (cell_size(grid, at) >= size) return act(at, s);
  const auto halve = [&](const auto& self, const Simplex& part, int axis, const std::array<int, 3>& low) -> void {
    if (axis == 3) return cut_by_cells(part, grid, act, low, size / 2);
    std::array<int, 3> high = low;
    high[axis] += size / 2;
    const auto below = [&](const Simplex& p) { self(self, p, axis + 1, low); };
    if (high[axis] >= grid.cells[axis]) return below(part);
    cut_at(part, axis, high[axis], below, [&](const Simplex& p) { self(self, p, axis + 1, high); });
  };
  halve(halve, s, 0, at);
}

/// A triangle is cut by the cells on both sides of the plane that it lies in.
template <class Act>
void cut_by_cells_beside(const TriangleCorners& t, const VoxelGrid& grid, const Act& act) {
  cut_by_cells(t, grid, [&](const std::array<int, 3>& at, const TriangleCorners& part) {
    for (int d = 0; d < 3; ++d) {
      const auto is_low = [&](const Vec3& x) { return std::abs(x[d] - at[d]) <= lattice_tolerance; };
      if (at[d] == 0 || !std::all_of(part.begin(), part.end(), is_low)) continue;
      std::array<int, 3> below = at;
      const int size = cell_size(grid, at);
      below[d] -= size;
      return cut_by_cells(
          part, grid, [&](const std::array<int, 3>&, const TriangleCorners& piece) { act(at, piece); }, below, size);
    }
    act(at, part);
  });
}

}  // namespace springproof
