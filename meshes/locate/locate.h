// Which hexahedron holds a point, and with which shape functions.
#pragma once

#include <optional>
#include <vector>

#include "meshes/mesh.h"

namespace springproof {

struct Location {
  std::size_t cell;                   ///< number in mesh.hexahedra
  Eigen::Matrix<double, 8, 1> shape;  ///< trilinear shape functions at the point; they sum to 1
};

/// Locates many points in the hexahedra of a mesh, which must outlive it: in constant time if the mesh has a grid, else
/// by a search through all cells.
class Locator {
 public:
  explicit Locator(const Mesh& mesh);

  /// The cell that holds the point (of several the first), or nothing (tolerance 1e-9 of a cell).
  std::optional<Location> find(const Vec3& point) const;

  /// As find, and for a point outside the cell nearest to it (of several at the same distance the first).  Its shape
  /// functions are continued linearly from its nearest point: they sum to 1 and reproduce linear fields, but are no
  /// longer within [0, 1].
  /// @throws std::invalid_argument if the mesh has no hexahedra or the point is not finite.
  Location operator()(const Vec3& point) const;

 private:
  int cell_at(int i, int j, int k) const;
  std::optional<Location> find_in_grid(const Vec3& point) const;
  Location nearest_in_grid(const Vec3& point) const;

  const Mesh* mesh_;
  std::vector<int> cell_of_box_;  ///< of the grid, x fastest; -1: none
};

/// For single points.
std::optional<Location> locate(const Mesh& mesh, const Vec3& point);
Location nearest(const Mesh& mesh, const Vec3& point);

}  // namespace springproof
