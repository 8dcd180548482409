// A body cut by a lattice of cubes along its true surface: what every cube holds of it, and of its patches.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "meshes/locate/tetrahedron_locator.h"
#include "meshes/mesh.h"
#include "meshes/voxels/filled_part.h"
#include "meshes/voxels/joined_cubes.h"
#include "meshes/voxels/voxelise.h"

namespace springproof {

/// A connected part of the body within one cube.
struct CutCell {
  std::array<int, 3> index;  ///< of the cube; of a larger one, of the lowest cube of the grid in it
  Hexahedron corners;        ///< points of the lattice; two parts of one cube share only corners through which they are
                             ///< connected outside it
  FilledPart filled;         ///< what the body fills of the cube
  int size = 1;              ///< edge of the cube, in edges of the grid
  int material = 0;          ///< of Mesh::materials
};

/// The part of a patch in one cell, by the trilinear weights N_a of the cell's corners.
struct PatchInCell {
  int cell;                      ///< its number
  std::array<double, 8> area{};  ///< integral of N_a [m^2]
  std::array<Vec3, 8> normal;    ///< integral of N_a n, n the outward unit normal [m^2]
  std::array<Vec3, 8> moment;    ///< integral of N_a (x - c), c the centre of the cell's cube [m^3]

  double total_area() const;  ///< [m^2]
};

/// The part of the interface of two materials between two cells, as a patch of each of them.
struct InterfaceInCells {
  std::array<PatchInCell, 2> sides;  ///< normals of both from the first to the second, which has the larger material
};

/// A point of the body's surface.
struct SurfacePoint {
  int cell;       ///< that it belongs to
  Vec3 position;  ///< [m]
};

/// A body in cells, with the parts of its patches in them.
class CutBody {
 public:
  VoxelGrid grid;                                           ///< of the cubes
  NodalVectors points;                                      ///< corners of the cells [m]
  std::vector<CarriedPoint> carried;                        ///< those in edges and faces of larger cells
  std::vector<CutCell> cells;                               ///< by layers: x fastest, then y, then z
  std::map<std::string, std::vector<PatchInCell>> patches;  ///< by name
  std::vector<InterfaceInCells> interfaces;                 ///< within cubes, by the cells of their sides
  /// Corners of the body, and where it meets edges of the lattice: of the parts of the surface in each cell the corners
  /// that lie farthest out, as seen along the faces, edges and corners of a cube, but for those that are less than 0.3
  /// of an edge from another.
  std::vector<SurfacePoint> surface;
  std::vector<std::string> notes;  ///< what was left out or is too thin, for the user

  /// A point by the corners of the cell that holds it; a point outside the body by those of a cell near to it,
  /// continued.
  struct Place {
    int cell;                       ///< its number
    std::array<double, 8> weights;  ///< trilinear; they sum to 1 and reproduce the point
  };
  Place place(const Vec3& point) const;  ///< of a point [m]

  /// Trilinear weights of the corners of a cell at a point.
  std::array<double, 8> weights(int cell, const Vec3& point) const;
  Vec3 centre(int cell) const;  ///< of the cube of a cell [m]

 private:
  friend CutBody cut_body(const VoxelGrid& grid, const Mesh& body);
  int nearest_cell(const Vec3& point, int material) const;

  std::vector<std::uint8_t> materials_;  ///< of the tetrahedra; empty: one
  std::shared_ptr<const TetrahedronLocator> locator_;
  std::vector<int> part_begin_;                ///< per tetrahedron, then the end
  std::vector<std::pair<long, int>> part_;     ///< cube and cell (-1: left out) of each part of a tetrahedron
  std::map<long, std::vector<int>> cells_of_;  ///< of a cube
};

/// Cuts the tetrahedra of a body by the planes of the grid: the moments of all parts are exact to round-off, and so are
/// the integrals over its patches.  Parts of less than 1/1000 of a cube are left out, and what is connected with the
/// rest of the body only through them; the patches there are attached to the nearest cell.
///
/// Each material is cut as a body of its own: where two share a cube it holds a cell of each, with corners of their
/// own, and the interface between them.  Where an interface lies in a plane of the lattice the cells on both sides
/// share corners, as those of one material do.
/// @throws std::invalid_argument if the body has no tetrahedra or reaches out of the grid, if a material has no cell,
/// or
///   if more than 2 % of the volume would be left out.
CutBody cut_body(const VoxelGrid& grid, const Mesh& body);

}  // namespace springproof
