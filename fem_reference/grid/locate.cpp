#include "fem_reference/grid/locate.h"

#include <deal.II/grid/grid_tools.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include "fem_reference/grid/processes.h"
#include "meshes/locate/tetrahedron_locator.h"
#include "problem/system/input_error.h"

namespace springproof::fem {
namespace {

/// A point in the coordinates of a cell, and how far outside of it in these.
struct InCell {
  Location place;
  double outside;
};

/// Nothing where the cell's mapping has no inverse.
template <class Cell>
std::optional<InCell> in_cell(const dealii::GridTools::Cache<3>& cache, const Cell& cell, const dealii::Point<3>& X) {
  try {
    const dealii::Point<3> unit = cache.get_mapping().transform_real_to_unit_cell(cell, X);
    const double outside = cell->reference_cell().is_simplex()
                               ? std::max({0.0, -unit[0], -unit[1], -unit[2], unit[0] + unit[1] + unit[2] - 1})
                               : unit.distance(dealii::GeometryInfo<3>::project_to_unit_cell(unit));
    return InCell{{cell, unit}, outside};
  } catch (const dealii::Mapping<3>::ExcTransformationFailed&) {
    return {};
  }
}

// Points further outside are refused, as a fraction of the adjacent cell (hexahedra) or of the body's extent
// (tetrahedra).
constexpr double furthest_outside_cell = 0.5, furthest_outside = 0.2;

[[noreturn]] void throw_outside(const dealii::Point<3>& X) {
  throw InputError(fmt::format("the point ({}, {}, {}) is outside the body", X[0], X[1], X[2]));
}

// For a point just outside the facetted body: among the cells at the nearest vertex, the one it is least outside of.
std::optional<InCell> locate_near(const dealii::Triangulation<3>& triangulation,
                                  const dealii::GridTools::Cache<3>& cache, const dealii::Point<3>& X) {
  const unsigned int vertex = dealii::GridTools::find_closest_vertex(cache.get_mapping(), triangulation, X);
  std::optional<InCell> best;
  for (const auto& cell : cache.get_vertex_to_cell_map()[vertex]) {
    if (cell->is_artificial()) continue;
    const auto at = in_cell(cache, cell, X);
    if (at && at->outside <= (best ? best->outside : furthest_outside_cell)) best = at;
  }
  return best;
}

constexpr double within = 1e-6;  // of a cell's size: a point this far outside counts as inside

// The locally owned cells that contain the point, up to `within`.
std::vector<Location> owned_cells_at(const dealii::GridTools::Cache<3>& cache, const dealii::Point<3>& X) {
  std::vector<Location> all;
  const auto& boxes = cache.get_locally_owned_cell_bounding_boxes_rtree();
  for (const auto& [box, cell] : boxes) {
    if (!box.point_inside(X, 0.1)) continue;  // a curved cell may extend beyond the bounding box of its nodes
    if (const auto at = in_cell(cache, cell, X); at && at->outside < within) all.push_back(at->place);
  }
  return all;
}

// A locally owned cell for a point, and how far outside it the point is; infinity if there is no such cell.
std::pair<Location, double> own_location(const Body3& body, const dealii::GridTools::Cache<3>& cache,
                                         const dealii::Point<3>& X) {
  const std::vector<Location> inside = owned_cells_at(cache, X);
  if (!inside.empty()) return {inside.front(), 0};
  const auto near = locate_near(body.triangulation, cache, X);
  if (!near || !near->place.cell->is_locally_owned()) return {{}, std::numeric_limits<double>::infinity()};
  return {near->place, std::max(within, near->outside)};
}

std::vector<Location> locate_among_processes(const Body3& body, const dealii::GridTools::Cache<3>& cache,
                                             const std::vector<dealii::Point<3>>& points) {
  struct Candidate {
    double distance;
    int rank;
  };
  std::vector<Location> places;
  std::vector<Candidate> own, first(points.size());
  for (const dealii::Point<3>& X : points) {
    const auto [place, distance] = own_location(body, cache, X);
    places.push_back(place);
    own.push_back({distance, process_rank()});
  }
  MPI_Allreduce(own.data(), first.data(), int(own.size()), MPI_DOUBLE_INT, MPI_MINLOC, MPI_COMM_WORLD);
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (std::isinf(first[k].distance)) throw_outside(points[k]);
    places[k].answers = first[k].rank == process_rank();
    if (own[k].distance > 0 && !places[k].answers) places[k].cell = Location().cell;
  }
  return places;
}

// Quadratic functions are not extrapolated far outside a small cell, as where a coarse mesh cuts off a tip.
dealii::Point<3> near_cell(Eigen::Vector4d weights) {
  if (weights.minCoeff() < -0.5) {
    weights = weights.cwiseMax(0.0);
    weights /= weights.sum();
  }
  return {weights[1], weights[2], weights[3]};
}

// Each process looks among its own cells.  The nearest cell answers, of several the first of the mesh, whichever
// processes there are; who else has a cell at the point has a place too.
std::vector<Location> locate_in_tetrahedra(const Body3& body, const NodalVectors& points) {
  const auto& vertices = body.triangulation.get_vertices();
  NodalVectors X(vertices.size(), 3);
  for (std::size_t v = 0; v < vertices.size(); ++v) X.row(v) << vertices[v][0], vertices[v][1], vertices[v][2];
  std::vector<dealii::Triangulation<3>::active_cell_iterator> own;
  std::vector<Tetrahedron> cells;
  for (const auto& cell : body.triangulation.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    own.push_back(cell);
    cells.push_back({int(cell->vertex_index(0)), int(cell->vertex_index(1)), int(cell->vertex_index(2)),
                     int(cell->vertex_index(3))});
  }
  const TetrahedronLocator locator(X, cells);
  const MPI_Comm comm = body.triangulation.get_communicator();
  using dealii::Utilities::MPI::min;
  const Vec3 low = X.colwise().minCoeff(), high = X.colwise().maxCoeff();
  Vec3 extent;
  for (int c = 0; c < 3; ++c) extent[c] = dealii::Utilities::MPI::max(high[c], comm) - min(low[c], comm);

  std::vector<Location> places;
  std::vector<double> outside, least(points.rows());
  std::vector<bool> touches;
  for (const auto& p : points.rowwise()) {
    const TetrahedronLocator::Place place = locator(p.transpose());
    places.push_back({own[place.cell], near_cell(place.weights)});
    outside.push_back(place.outside);
    touches.push_back(place.weights.minCoeff() > -within);
  }
  min(outside, comm, least);
  std::vector<unsigned int> number, first(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (least[k] > furthest_outside * extent.norm()) throw_outside({points(k, 0), points(k, 1), points(k, 2)});
    number.push_back(outside[k] > least[k] ? dealii::numbers::invalid_unsigned_int
                                           : unsigned(places[k].cell->id().get_coarse_cell_id()));
  }
  min(number, comm, first);
  for (std::size_t k = 0; k < places.size(); ++k) {
    places[k].answers = number[k] == first[k];
    if (!places[k].answers && !touches[k]) places[k].cell = Location().cell;
  }
  return places;
}

}  // namespace

std::vector<Location> locate(const Body3& body, const NodalVectors& points) {
  std::vector<Location> places(points.rows());
  if (places.empty()) return places;
  if (body.has_tetrahedra()) return locate_in_tetrahedra(body, points);
  const dealii::GridTools::Cache<3> cache(body.triangulation, *body.mapping);
  std::vector<dealii::Point<3>> X;
  for (const auto& p : points.rowwise()) X.emplace_back(p[0], p[1], p[2]);
  if (process_count() > 1) return locate_among_processes(body, cache, X);
  const auto [cells, units, indices, missing] = dealii::GridTools::compute_point_locations_try_all(cache, X);
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t k = 0; k < indices[c].size(); ++k) places[indices[c][k]] = {cells[c], units[c][k]};
  for (const unsigned int i : missing) {
    const auto near = locate_near(body.triangulation, cache, X[i]);
    if (!near) throw_outside(X[i]);
    places[i] = near->place;
  }
  return places;
}

std::vector<Location> cells_around(const dealii::GridTools::Cache<3>& cache, const Location& first, const Vec3& X) {
  std::set<dealii::Triangulation<3>::active_cell_iterator> neighbours;
  for (const unsigned int v : first.cell->vertex_indices())
    for (const auto& cell : cache.get_vertex_to_cell_map()[first.cell->vertex_index(v)]) neighbours.insert(cell);
  std::vector<Location> all = {first};
  for (const auto& cell : neighbours) {
    if (cell == first.cell || !cell->is_locally_owned()) continue;
    if (const auto at = in_cell(cache, cell, {X[0], X[1], X[2]}); at && at->outside < within) all.push_back(at->place);
  }
  return all;
}

}  // namespace springproof::fem
