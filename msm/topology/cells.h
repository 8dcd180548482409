// The cells of a network: cubes or boxes, full or cut by the surface of the body.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "meshes/mesh.h"
#include "meshes/voxels/filled_part.h"
#include "meshes/voxels/joined_cubes.h"

namespace springproof {

/// Linear spring between nodes i < j: energy k/2 (L' - L)^2.
struct Spring {
  int i;               ///< node
  int j;               ///< node, j > i
  double stiffness;    ///< k [N/m]
  double rest_length;  ///< L [m]
};

/// What the cells of a network are.
enum class CellKind {
  none,   ///< there are none: springs between nodes
  cubes,  ///< full cubes of one size
  boxes,  ///< full boxes of one size that are no cubes
  cut,    ///< cubes of one size that the body fills in part
  sizes,  ///< the same, of several sizes
};

/// What the stiffness of a cell depends on beside its law.  What is measured or given per cell belongs here.
struct CellShape {
  double edge;                      ///< l [m]; of a box that of the cube of its volume
  FilledPart part = {};             ///< that the body fills
  Vec3 proportions = Vec3::Ones();  ///< edges of a box over l, of product one; cubes: 1
  int material = 0;                 ///< its number: laws have constants of each

  double volume() const { return part.fraction * edge * edge * edge; }  ///< of the filled part [m^3]
};

/// The cells of a network.
struct CellSet {
  std::vector<Hexahedron> corners;  ///< nodes of each cell; empty for networks without
  double edge = 0;  ///< l [m]: of several sizes of the smallest; of boxes of their cube; of a lattice of
                    ///< springs without cells its spacing
  Vec3 proportions = Vec3::Ones();         ///< edges of boxes over those of the cube of their volume; cubes: 1
  std::vector<double> edges;               ///< [m] of each cell, if they are of several sizes
  std::vector<FilledPart> filled;          ///< of each cell, if they are cut
  std::vector<std::uint8_t> materials;     ///< of each cell, if there are several
  std::vector<double> relative_densities;  ///< of each material, over that of material 0; empty: 1
  /// Nodes on edges and faces of larger cells.  They are no unknowns: they follow the others, to which the forces on
  /// them, and their mass, are handed back.
  std::vector<CarriedPoint> carried;
  std::vector<Spring> springs;  ///< contribution of one cell: springs between its corners 0..7
  std::optional<Grid> grid;     ///< the lattice of the cells

  /// @return what they are
  CellKind kind() const;
  bool empty() const { return corners.empty(); }       ///< there are none
  std::size_t size() const { return corners.size(); }  ///< how many
  /// @return whether the body fills some in part only: CellKind::cut or sizes
  bool cut() const { return !filled.empty(); }
  /// @param cell its number
  /// @return its edge [m], that of the cube of its volume
  double edge_of(std::size_t cell) const { return edges.empty() ? edge : edges[cell]; }
  /// @param cell its number
  /// @return what the body fills of it
  const FilledPart& part(std::size_t cell) const;
  /// @param cell its number
  /// @return whether it is as all other full cells of its edge and material are
  bool is_full(std::size_t cell) const { return part(cell).fraction == 1; }
  /// @param cell its number
  /// @return the number of its material
  int material(std::size_t cell) const { return materials.empty() ? 0 : materials[cell]; }
  /// @param cell its number
  /// @return all that its stiffness depends on beside its law
  CellShape shape(std::size_t cell) const { return {edge_of(cell), part(cell), proportions, material(cell)}; }
  /// @return of a full cell, the smallest if there are several sizes
  CellShape full() const { return {edge, {}, proportions}; }
  /// @return of a full cell, the smallest if there are several sizes [m^3]
  double volume() const { return edge * edge * edge; }

  /// Some of the cells, with the same nodes.
  /// @param numbers of the cells
  /// @return these, without grid
  CellSet of(const std::vector<int>& numbers) const;
};

}  // namespace springproof
