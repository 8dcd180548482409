// A body cut into hexahedra or tetrahedra, with named surface patches.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "problem/vector.h"

namespace springproof {

/// Corner order of gmsh and VTK: (0,0,0) (1,0,0) (1,1,0) (0,1,0) (0,0,1) (1,0,1) (1,1,1) (0,1,1).
using Hexahedron = std::array<int, 8>;
/// Corners such that the volume is positive: the fourth is on the side of the normal of the first three.
using Tetrahedron = std::array<int, 4>;

/// Corners of a hexahedron in the unit cube, in that order.
inline constexpr std::array<std::array<int, 3>, 8> hexahedron_corners = {
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// Corners of each face, outward by the right-hand rule, in the order x_min x_max y_min y_max z_min z_max of the
/// reference cube.
inline constexpr std::array<std::array<int, 4>, 6> hexahedron_faces = {
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};

/// Nodes of a face of a cell.
/// @param cell the cell
/// @param f number of the face, 0 to 5, as in hexahedron_faces
/// @return four nodes, outward by the right-hand rule
inline std::array<int, 4> face_of(const Hexahedron& cell, int f) {
  const auto& corners = hexahedron_faces[f];
  return {cell[corners[0]], cell[corners[1]], cell[corners[2]], cell[corners[3]]};
}

/// Named part of the surface.  Facets have outward normals by the right-hand rule; a triangle has facet[3] = -1.
struct Patch {
  std::string name;                        ///< as case files and loads refer to it
  std::vector<std::array<int, 4>> facets;  ///< node numbers
};

/// A cubic lattice that a mesh was cut from: cell (i,j,k) spans origin + edge * [i,i+1]x[j,j+1]x[k,k+1].
struct Grid {
  std::array<int, 3> cells;                    ///< nx, ny, nz
  Vec3 origin = Vec3::Zero();                  ///< [m]
  Vec3 spacing = Vec3::Zero();                 ///< edge lengths [m]; equal for a cubic lattice
  std::vector<std::array<int, 3>> cell_index;  ///< (i,j,k) of each hexahedron of the mesh
};

/// A body cut into hexahedra or tetrahedra.
struct Mesh {
  NodalVectors nodes;                   ///< rest positions [m], n x 3
  std::vector<Hexahedron> hexahedra;    ///< their corners
  std::vector<Tetrahedron> tetrahedra;  ///< their corners
  std::vector<Patch> patches;           ///< named parts of the surface; they may overlap
  std::optional<Grid> grid;             ///< set when every cell is a box of one lattice
  NodalVectors curved;  ///< second-order hexahedra: 27 points of each cell [m], x fastest in the frame of
                        ///< its corners; empty: edges are straight
  /// Material of each cell: 0 is that of the body, r that of its region number r.  Empty: one material everywhere.
  std::vector<std::uint8_t> materials = {};
};

/// The patch of a name.
/// @param mesh a body
/// @param name of the patch
/// @return it, part of the mesh
/// @throws std::invalid_argument naming the patches there are, if there is none of that name.
const Patch& patch(const Mesh& mesh, const std::string& name);

/// Nodes of a patch.
/// @param patch of any mesh
/// @return their numbers, ascending, each once
std::vector<int> nodes_of(const Patch& patch);

/// Share of each node in the patch's area [m^2]: a facet's area split by its shape functions (consistent load of a
/// uniform traction).
/// @param mesh a body
/// @param patch one of its patches
/// @return one value per mesh node, zero off the patch
Eigen::VectorXd nodal_areas(const Mesh& mesh, const Patch& patch);

/// Centroid of a patch.
/// @param mesh a body
/// @param patch one of its patches
/// @return that of its area [m]
Vec3 centroid(const Mesh& mesh, const Patch& patch);

/// Volume share of each node: an eighth of each hexahedron, a quarter of each tetrahedron.
/// @param mesh a body
/// @return one value per node [m^3]; their sum is the volume
Eigen::VectorXd nodal_volumes(const Mesh& mesh);

/// Parts of a mesh that share no node.
/// @param mesh a body
/// @return their number; 1: the body is in one piece
int separate_parts(const Mesh& mesh);

/// The grid of a mesh whose hexahedra are equal axis-aligned boxes of one lattice (any subset of its cells), each
/// with its lowest corner first, in the corner order above; else nothing.  Nodes may be off the lattice by 1e-9 of the
/// body's extent along that axis.  One cell per box and one mesh node per lattice point, or it is no grid.
/// @param mesh a body
/// @return the grid, or nothing
std::optional<Grid> detect_grid(const Mesh& mesh);

/// Axis-aligned block [0,size] cut into equal boxes, nodes numbered x fastest, patches x_min x_max y_min y_max z_min
/// z_max: the mesh gmsh makes of block.geo, without gmsh.
/// @param size edges of the block [m]
/// @param cells numbers of boxes along x, y and z
/// @return the mesh, its grid set; the boxes are cubes if the size is in proportion to the numbers
/// @throws std::invalid_argument unless the size is positive and there is a box along each axis.
Mesh block_mesh(const Vec3& size, const std::array<int, 3>& cells);

}  // namespace springproof
