// The cells that contain a point.
#pragma once

#include <deal.II/grid/grid_tools_cache.h>

#include <vector>

#include "fem_reference/grid/triangulate.h"
#include "problem/vector.h"

namespace springproof::fem {

/// A rest position inside a cell.  Of the processes that own a cell containing the point, one evaluates it (`answers`).
struct Location {
  dealii::Triangulation<3>::active_cell_iterator cell;
  dealii::Point<3> unit;
  bool answers = true;

  bool is_here() const { return cell.state() == dealii::IteratorState::valid; }
};

/// @throws InputError naming the first point that is further outside the body than half the adjacent cell (tetrahedra:
/// 0.2 of the body's extent).
std::vector<Location> locate(const Body3& body, const NodalVectors& points);

/// `first`, which is that of the point X, and the other locally owned cells that contain it.
std::vector<Location> cells_around(const dealii::GridTools::Cache<3>& cache, const Location& first, const Vec3& X);

}  // namespace springproof::fem
