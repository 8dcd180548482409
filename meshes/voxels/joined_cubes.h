// Cubes of several sizes as cells with common corners: which corners are the same, and which a larger cube carries.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "meshes/mesh.h"

namespace springproof {

/// A cube of a lattice, whose edge is `size` edges of the smallest cubes; its place is a multiple of its size.
struct LatticeCube {
  std::array<int, 3> at;  ///< lowest corner, in edges of the smallest cubes
  int size = 1;           ///< a power of two

  /// Corner n, in edges of the smallest cubes.
  std::array<int, 3> corner(int n) const;
};

/// A point on an edge or a face of a larger cube, in the average of corners of it.
struct CarriedPoint {
  int point;
  std::vector<int> by;  ///< two or four points; they may be carried by a larger cube again
};

/// Cells with common corners.
struct JoinedCubes {
  std::vector<Hexahedron> corners;         ///< points of each cube
  std::vector<std::array<int, 3>> points;  ///< their places
  std::vector<CarriedPoint> carried;       ///< after all points by which they are carried
};

/// Joins cubes that are linked.  Of cubes of one size the corners in one place are the same.  Corners of a smaller cube
/// in the boundary of a larger one are its corners, or carried by it.  Sizes of linked cubes differ by a factor of two
/// at most.
JoinedCubes join_cubes(const std::vector<LatticeCube>& cubes, const std::vector<std::array<int, 2>>& links);

/// Per point those that carry it in the end, with their weights, which sum to 1; none for a point that nothing carries.
using Carriers = std::vector<std::vector<std::pair<int, double>>>;
/// Of `points` points; empty if none is carried.
Carriers carriers_of(int points, const std::vector<CarriedPoint>& carried);

/// Calls act(point, weight) with those that carry a point in the end, or with itself.
template <class Act>
void for_each_carrier(const Carriers& carriers, int point, const Act& act) {
  if (carriers.empty() || carriers[point].empty()) return act(point, 1.0);
  for (const auto& [by, weight] : carriers[point]) act(by, weight);
}

/// Values of carried points from those of the others; a field of three values per point, one after the other.
template <class Field>
void carry(const std::vector<CarriedPoint>& carried, Field& field) {
  using Value = typename Field::Scalar;
  Value* u = field.data();
  for (const CarriedPoint& c : carried)
    for (int d = 0; d < 3; ++d) {
      Value sum = 0;
      for (const int p : c.by) sum += u[3 * p + d];
      u[3 * c.point + d] = sum / static_cast<Value>(c.by.size());
    }
}

/// The transpose: what acts on carried points is handed back to the others; `values` per point.
template <class Field>
void hand_back(const std::vector<CarriedPoint>& carried, Field& field, int values = 3) {
  using Value = typename Field::Scalar;
  Value* f = field.data();
  for (auto c = carried.rbegin(); c != carried.rend(); ++c)
    for (int d = 0; d < values; ++d) {
      const Value share = f[values * c->point + d] / static_cast<Value>(c->by.size());
      for (const int p : c->by) f[values * p + d] += share;
      f[values * c->point + d] = 0;
    }
}

}  // namespace springproof
