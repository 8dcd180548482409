// The parts of a body of tetrahedra in the cubes of a lattice, and which of them are connected.
#pragma once

#include <set>
#include <vector>

#include "meshes/mesh.h"
#include "meshes/united_numbers.h"
#include "meshes/voxels/cut_simplex.h"
#include "meshes/voxels/voxelise.h"

namespace springproof {

// All lengths in edges of the grid's cubes, from its origin; a cell is known by the number of its lowest cube.

/// Moments of a solid, to second order.
struct SolidMoments {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  void add(const TetrahedronCorners& t);
  void add(const SolidMoments& m);
};

double area_of(const TriangleCorners& t);

/// The parts of the tetrahedra in the cubes, those of a tetrahedron one after the other, and how they are connected.
class BodyParts {
 public:
  BodyParts(const VoxelGrid& grid, const Mesh& body);

  std::array<int, 3> index(long cube) const;  ///< (i,j,k) of a cube from its number
  int size(long cube) const;                  ///< of the cell whose lowest cube that is

  /// Part of a tetrahedron in a cube; -1: none.
  int find(int tetrahedron, long cube) const;

  /// The cube that holds a part of a facet of a tetrahedron; of two between which it lies, the one on that side.
  long cube_beside(const TriangleCorners& part, int tetrahedron) const;

  TriangleCorners triangle(const std::array<int, 3>& nodes) const { return {X_[nodes[0]], X_[nodes[1]], X_[nodes[2]]}; }

  /// The tetrahedron that has a facet of the surface.
  /// @throws std::invalid_argument if there is none.
  int owner(const std::array<int, 3>& nodes) const;

  /// Material of a tetrahedron.
  int material(int tetrahedron) const { return body_.materials.empty() ? 0 : body_.materials[tetrahedron]; }

  std::vector<int> begin;  ///< first part of each tetrahedron, then the end
  std::vector<long> cube;
  std::vector<SolidMoments> moments;
  std::vector<std::array<int, 2>> in_cube;  ///< parts of one material connected within a cube
  std::vector<std::array<int, 2>> to_next;  ///< parts connected through a face between two cubes

  /// A part of a facet within a cube, between parts of two tetrahedra of different materials; it is anticlockwise seen
  /// from that of the larger one.
  struct Interface {
    std::array<int, 2> parts;  ///< that of the smaller material first
    TriangleCorners triangle;
  };
  std::vector<Interface> interfaces;

 private:
  /// A facet of a tetrahedron, its nodes in ascending order.
  struct TetrahedronFacet {
    std::array<int, 3> nodes;
    int tetrahedron;
    bool operator<(const TetrahedronFacet& other) const;
  };

  void list_facets();
  int find_or_add(long cube);
  bool share_a_face(long a, long b) const;
  void find_mixed_cubes();
  bool touch_a_mixed_cube(long a, long b) const;
  void connect();
  void connect(const std::array<int, 3>& facet, int a, int b);
  void add_interface(int p, int q, int a, int b, TriangleCorners part);

  const VoxelGrid& grid_;
  const Mesh& body_;
  std::vector<TetrahedronFacet> facets_;
  std::vector<Vec3> X_;
  std::set<long> mixed_;  ///< cubes in which several materials have cells
};

/// What is connected within a cube, as one solid.
struct BodyPieces {
  explicit BodyPieces(const BodyParts& parts);

  /// Numbers the pieces that are kept in the order of their cubes: those of at least 1/1000 of a cube that are
  /// connected through such, or meet in an interface.  Returns the fraction of the volume that is left out.
  double number_cells();

  std::vector<int> of_part;
  std::vector<long> cube;
  std::vector<SolidMoments> moments;
  std::vector<int> material;
  std::vector<std::array<int, 2>> links;  ///< through faces
  std::vector<std::array<int, 2>> meets;  ///< in an interface within a cube
  std::vector<double> capacity;           ///< volume of the cell that it is in
  std::vector<int> cell;                  ///< its number as a cell; -1: left out

 private:
  /// Large pieces that an interface ties: those that meet, and in the place of a small one those of its material
  /// beside.
  std::vector<std::array<int, 2>> bonded(const std::vector<char>& large) const;
};

}  // namespace springproof
