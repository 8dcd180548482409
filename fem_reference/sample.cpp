#include "fem_reference/sample.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/grid_tools_cache.h>
#include <fmt/format.h>

#include "problem/experiment.h"

namespace springproof::fem {
namespace {

double distance_outside_unit_cell(const dealii::Point<3>& unit) {
  return unit.distance(dealii::GeometryInfo<3>::project_to_unit_cell(unit));
}

// For a point just outside the facetted body: the cell at the nearest vertex that it is least outside of.
Location locate_near(const dealii::Triangulation<3>& triangulation, const dealii::GridTools::Cache<3>& cache,
                     const dealii::Point<3>& X) {
  const auto& mapping = cache.get_mapping();
  const unsigned int vertex = dealii::GridTools::find_closest_vertex(mapping, triangulation, X);
  Location best;
  double least = 0.5;
  bool found = false;
  for (const auto& cell : cache.get_vertex_to_cell_map()[vertex]) {
    try {
      const dealii::Point<3> unit = mapping.transform_real_to_unit_cell(cell, X);
      const double outside = distance_outside_unit_cell(unit);
      if (outside > least) continue;
      least = outside;
      best = {cell, unit};
      found = true;
    } catch (const dealii::Mapping<3>::ExcTransformationFailed&) {
    }
  }
  if (!found) throw InputError(fmt::format("the point ({}, {}, {}) is outside the body", X[0], X[1], X[2]));
  return best;
}

}  // namespace

std::vector<dealii::types::global_dof_index> dofs_at(const Location& place,
                                                     const dealii::DoFHandler<3>& dof_handler) {
  const dealii::DoFHandler<3>::active_cell_iterator cell(
      &dof_handler.get_triangulation(), place.cell->level(), place.cell->index(), &dof_handler);
  std::vector<dealii::types::global_dof_index> dofs(dof_handler.get_fe().n_dofs_per_cell());
  cell->get_dof_indices(dofs);
  return dofs;
}

std::vector<Location> locate(const dealii::Triangulation<3>& triangulation, const NodalVectors& points) {
  std::vector<Location> places(points.rows());
  if (places.empty()) return places;
  const dealii::MappingQ1<3> mapping;
  const dealii::GridTools::Cache<3> cache(triangulation, mapping);
  std::vector<dealii::Point<3>> X;
  for (const auto& p : points.rowwise()) X.emplace_back(p[0], p[1], p[2]);
  const auto [cells, units, indices, missing] = dealii::GridTools::compute_point_locations_try_all(cache, X);
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t k = 0; k < indices[c].size(); ++k) places[indices[c][k]] = {cells[c], units[c][k]};
  for (const unsigned int i : missing) places[i] = locate_near(triangulation, cache, X[i]);
  return places;
}

NodalVectors displacement_at(const std::vector<Location>& places, const dealii::DoFHandler<3>& dof_handler,
                             const DofVector& displacement) {
  const auto& scalar = dof_handler.get_fe().base_element(0);
  NodalVectors u = NodalVectors::Zero(places.size(), 3);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto dofs = dofs_at(places[k], dof_handler);
    for (unsigned int a = 0; a < scalar.n_dofs_per_cell(); ++a) {
      const double N = scalar.shape_value(a, places[k].unit);
      for (int c = 0; c < 3; ++c)
        u(k, c) += N * displacement[dofs[dof_handler.get_fe().component_to_system_index(c, a)]];
    }
  }
  return u;
}

VolumeMeasure measure_volume(const dealii::DoFHandler<3>& dof_handler, const DofVector& displacement) {
  const dealii::MappingQ1<3> mapping;
  const auto& fe = dof_handler.get_fe();
  dealii::FEValues<3> values(mapping, fe, dealii::QGauss<3>(fe.degree + 1),
                             dealii::update_gradients | dealii::update_JxW_values);
  const dealii::FEValuesExtractors::Vector vector(0);
  std::vector<dealii::Tensor<2, 3>> gradients(values.n_quadrature_points);
  VolumeMeasure measure;
  double volume = 0;
  for (const auto& cell : dof_handler.active_cell_iterators()) {
    values.reinit(cell);
    values[vector].get_function_gradients(displacement, gradients);
    for (const unsigned int q : values.quadrature_point_indices()) {
      const dealii::Tensor<2, 3> h = gradients[q];
      const double trace_h = dealii::trace(h);
      // det(I + h) - 1 by its invariants, without cancellation
      const double det_minus_1 =
          trace_h + (trace_h * trace_h - dealii::trace(h * h)) / 2 + dealii::determinant(h);
      volume += values.JxW(q);
      measure.change += values.JxW(q) * det_minus_1;
      measure.change_first_order += values.JxW(q) * trace_h;
      measure.min_jacobian = std::min(measure.min_jacobian, 1 + det_minus_1);
    }
  }
  measure.change /= volume;
  measure.change_first_order /= volume;
  return measure;
}

}  // namespace springproof::fem
