// Numbers taken from a solution: displacement and stress at points, volume.
#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <optional>

#include "fem_reference/elastic_system.h"
#include "fem_reference/reference.h"
#include "problem/vector.h"

namespace springproof::fem {

/// A rest position inside a cell.  Of several processes some have a cell that holds the point, and one of them answers.
struct Location {
  dealii::Triangulation<3>::active_cell_iterator cell;
  dealii::Point<3> unit;
  bool answers = true;

  bool is_here() const { return cell.state() == dealii::IteratorState::valid; }
};

/// The degrees of freedom of the cell at a place.
std::vector<dealii::types::global_dof_index> dofs_at(const Location& place, const dealii::DoFHandler<3>& dof_handler);

/// @throws InputError naming the first point that is further outside the body than half the cell next to it.
std::vector<Location> locate(const Body3& body, const NodalVectors& points);

/// n x 3 [m].  The displacement holds the values of other processes on the cells around (as do those below).
NodalVectors displacement_at(const std::vector<Location>& places, const dealii::DoFHandler<3>& dof_handler,
                             const DofVector& displacement);

/// Cauchy stress at rest positions, extrapolated from the points where each cell knows it best, the mean of the cells
/// that meet there; without a law, of small strain.
Stresses stress_at(const NodalVectors& points, const ElasticSystem& system, std::optional<Law> law,
                   const ElasticAnswer& answer, const DofVector& displacement);

struct VolumeMeasure {
  double change = 0;              ///< integral of det(I + grad u) - 1, over V
  double change_first_order = 0;  ///< integral of div u over V
  double min_jacobian = 1;        ///< min det(I + grad u) at quadrature points
};

VolumeMeasure measure_volume(const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                             const DofVector& displacement);

}  // namespace springproof::fem
