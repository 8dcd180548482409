// Which points of a lattice lie inside a closed surface.
#pragma once

#include <array>
#include <vector>

#include "problem/vector.h"

namespace springproof {

/// Lattice points (i, j, k) with begin <= i < end, row = k * ny + j.
struct RowRun {
  int row;
  int begin, end;
};

/// The points with integer coordinates 0 <= i < n[0] and so on that lie inside, by ascending row and i; runs of a row
/// do not touch. Lines along x through the lattice points count how often they cross the surface.  Every edge must
/// belong to an even number of triangles; orientation does not matter.  `points` are in units of the lattice.
std::vector<RowRun> runs_inside(const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles,
                                const std::array<int, 3>& n);

}  // namespace springproof
