// Which hexahedron holds a point, and with which shape functions.
#pragma once

#include <optional>

#include "meshes/mesh.h"

namespace springproof {

struct Location {
  std::size_t cell;                    ///< number in mesh.hexahedra
  Eigen::Matrix<double, 8, 1> shape;   ///< trilinear shape functions at the point; they sum to 1
};

/// Nothing if the point lies in no hexahedron (tolerance 1e-9 of a cell).
std::optional<Location> locate(const Mesh& mesh, const Vec3& point);

}  // namespace springproof
