// A mesh with a node in the middle of every edge: the elements C3D20 and C3D10 of Abaqus and CalculiX, their shape
// functions and integrals of these.
#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <vector>

#include "meshes/mesh.h"

namespace springproof::calculix {

/// Side of an element: `face` counts from 1 as in *SURFACE (S1 ... S6).
struct Side {
  int element;
  int face;
};

struct QuadraticPatch {
  std::string name;
  std::vector<Side> sides;
  std::vector<int> nodes;  ///< ascending, each once
};

struct QuadraticMesh {
  NodalVectors nodes;                      ///< rest positions [m]; those of the Mesh first, then the middles
  std::vector<std::vector<int>> elements;  ///< 20 or 10 nodes each, in Abaqus' order; hexahedra first
  std::vector<QuadraticPatch> patches;
};

QuadraticMesh quadratic(const Mesh& mesh);

/// Shape functions and their derivatives at a point of the reference element: [-1, 1]^3 for 20 nodes, the
/// corner of the unit cube (0 <= r, s, t and r + s + t <= 1) for 10.
struct Basis {
  Eigen::VectorXd value;
  Eigen::Matrix<double, Eigen::Dynamic, 3> gradient;
};
Basis basis(std::size_t nodes, const Vec3& xi);

/// Integral of each node's shape function over a patch at rest [m^2]: consistent loads of a uniform traction.
Eigen::VectorXd nodal_areas(const QuadraticMesh& mesh, const QuadraticPatch& patch);

/// The same of the area vector, pointing into the body: consistent loads of a unit pressure at rest.
NodalVectors nodal_area_vectors(const QuadraticMesh& mesh, const QuadraticPatch& patch);

/// The same over the body [m^3].
Eigen::VectorXd nodal_volumes(const QuadraticMesh& mesh);

/// Consistent loads [N] of a body force given at rest positions [N/m^3].
NodalVectors nodal_body_forces(const QuadraticMesh& mesh, const std::function<Vec3(const Vec3&)>& body_force);

/// Values of the nodes' shape functions [1], one row per point.
using NodalWeights = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// At rest positions inside the body.
/// @param linear the mesh from which `mesh` was made: of hexahedra or of tetrahedra
/// @param points n x 3 [m]
/// @param reach beyond tetrahedra, as far as the nearest is taken for a point [m]
/// @throws InputError naming a point if it lies in no element.
NodalWeights weights_at(const QuadraticMesh& mesh, const Mesh& linear, const NodalVectors& points, double reach = 0);

struct VolumeChange {
  double exact = 0;        ///< (V' - V) / V, by the elements' own interpolation [1]
  double first_order = 0;  ///< integral of div u / V [1]
};
VolumeChange volume_change(const QuadraticMesh& mesh, const NodalVectors& displacement);

}  // namespace springproof::calculix
