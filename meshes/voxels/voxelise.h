// A body as a set of equal cubes.
#pragma once

#include <string>
#include <vector>

#include "meshes/mesh.h"

namespace springproof {

/// The cubes that a body may take: cube (i,j,k) spans origin + edge * [i,i+1]x[j,j+1]x[k,k+1].
struct VoxelGrid {
  Vec3 origin = Vec3::Zero();            ///< [m]
  double edge = 0;                       ///< [m]
  std::array<int, 3> cells = {0, 0, 0};  ///< numbers of cubes along x, y and z
  /// Of cut_body(): per cube how often the edge of the cell that holds it is doubled; the numbers of cubes are
  /// multiples of the largest cell.  Empty: cells are cubes.
  std::vector<unsigned char> doubled = {};
};

/// Number of cube (i,j,k), x fastest.
long cube_number(const VoxelGrid& grid, const std::array<int, 3>& cube);
/// Edge of the cell that holds a cube, in edges of cubes.
int cell_size(const VoxelGrid& grid, const std::array<int, 3>& cube);
/// The lowest cube of the cell that holds a cube.
std::array<int, 3> cell_at(const VoxelGrid& grid, const std::array<int, 3>& cube);
/// The cube (i,j,k) that holds a point; of a point outside the nearest one.
std::array<int, 3> cube_at(const VoxelGrid& grid, const Vec3& point);

/// The smallest grid of cubes of that edge [m] that holds the body, centred on its bounding box.
/// @throws std::invalid_argument if the body has no cells, or the edge is not positive or gives more than 10^9 cubes.
VoxelGrid voxel_grid(const Mesh& body, double edge);

/// The cubes of a body.
struct Voxels {
  Mesh mesh;                       ///< hexahedra, x fastest, and the nodes they use; the grid is set
  std::vector<std::string> notes;  ///< what was left out, for the user
};

/// The cubes of the grid whose centres lie in the body.  Its surface are the outer facets of the mesh, quadrilaterals
/// cut into two triangles; where it runs through centres, those at its low side in x, y and z are in and those at its
/// high side are out. Each outer facet of the cubes gets the patches of the body's outer facet that is nearest to its
/// middle (none, if that one has none). The cubes are connected through faces.  Others are left out, with a note, if
/// they are at most 2 %.
/// @throws std::invalid_argument if the body reaches out of the grid, no centre lies inside, or more than 2 % would be
/// left out.
Voxels voxelise(const VoxelGrid& grid, const Mesh& body);

}  // namespace springproof
