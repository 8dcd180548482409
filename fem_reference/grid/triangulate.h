// Converts a mesh to a deal.II triangulation: hexahedra, with a multigrid hierarchy where edges are straight, or
// tetrahedra.
#pragma once

#include <deal.II/base/quadrature.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/grid/tria.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "meshes/mesh.h"

namespace springproof::fem {

struct Body3 {
  explicit Body3(std::unique_ptr<dealii::Triangulation<3>> cells) : owned(std::move(cells)), triangulation(*owned) {}

  std::unique_ptr<dealii::Triangulation<3>> owned;
  dealii::Triangulation<3>& triangulation;  ///< with several processes: locally owned and ghost cells
  std::unique_ptr<dealii::Mapping<3>> mapping;
  bool curved = false;  ///< edges are those of Mesh::curved; else straight
  std::map<std::string, std::set<dealii::types::boundary_id>> patches;  ///< a facet may belong to several patches

  /// Of tetrahedra of several materials: the same cells, those of each material with vertices of their own, so that
  /// continuous pressures jump where materials meet; else empty.
  std::unique_ptr<dealii::Triangulation<3>> apart = {};

  /// What pressures are unknowns on.
  dealii::Triangulation<3>& of_pressures() const { return apart ? *apart : triangulation; }

  bool has_tetrahedra() const { return triangulation.get_reference_cells().front().is_simplex(); }
};

/// Refines the mesh `refinements` times; then every vertex X [m] of the finest mesh is moved to place(X), if given.
/// Curved meshes and tetrahedra are not refined; of several processes only the first is given such a mesh, which it
/// divides, and the others one without cells.  Any other is given to all (every_process_needs()).
/// @throws InputError on every process if the mesh has inverted cells, no cells, or both kinds.
std::unique_ptr<Body3> triangulate(const Mesh& mesh, int refinements, const std::function<Vec3(const Vec3&)>& place);

/// Lagrange elements of degree 1 or 2.
std::unique_ptr<dealii::FiniteElement<3>> scalar_element(const Body3& body, int degree);

/// Three components of them.
std::unique_ptr<dealii::FESystem<3>> displacement_element(const Body3& body, int degree);

/// The pressures of the mixed form beside displacements of this degree (element.h).
std::unique_ptr<dealii::FiniteElement<3>> pressure_element(const Body3& body, int degree);

/// The handler's degrees of freedom in a cell, of its own or of another triangulation of the same cells.
template <class Cell>
std::vector<dealii::types::global_dof_index> dofs_in(const Cell& cell, const dealii::DoFHandler<3>& handler) {
  std::vector<dealii::types::global_dof_index> dofs(handler.get_fe().n_dofs_per_cell());
  dealii::DoFHandler<3>::active_cell_iterator(&handler.get_triangulation(), cell->level(), cell->index(), &handler)
      ->get_dof_indices(dofs);
  return dofs;
}

/// Shape functions at the points of a rule, one row per point.
Eigen::MatrixXd values_at(const dealii::FiniteElement<3>& fe, const dealii::Quadrature<3>& quadrature);

/// Exact for polynomials of degree 2 n - 1 (hexahedra: in each coordinate); n up to 4.
dealii::Quadrature<3> cell_quadrature(const Body3& body, unsigned int n);
dealii::Quadrature<2> face_quadrature(const Body3& body, unsigned int n);

}  // namespace springproof::fem
