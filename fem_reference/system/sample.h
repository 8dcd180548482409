// Evaluation of a solution: displacement and stress at points, volume change.
#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <optional>

#include "fem_reference/exchange/request.h"
#include "fem_reference/grid/locate.h"
#include "fem_reference/system/elastic_system.h"
#include "problem/vector.h"

namespace springproof::fem {

/// n x 3 [m].  The displacement must have current ghost values, here and below.
NodalVectors displacement_at(const std::vector<Location>& places, const dealii::DoFHandler<3>& dof_handler,
                             const DofVector& displacement);

/// Cauchy stress at rest positions, extrapolated from the superconvergent points of each cell and averaged over the
/// cells that meet there, where materials meet over those of the least; without a law, for small strain.
Stresses stress_at(const NodalVectors& points, const ElasticSystem& system, std::optional<Law> law,
                   const ElasticAnswer& answer, const DofVector& displacement);

/// A solution at the nodes of its own elements, which are there once for each material.
struct NodalSolution {
  NodalVectors X, displacement;         ///< rest positions and displacements [m], n x 3
  Stresses stress;                      ///< as stress_at() gives them [Pa], n x 6
  std::vector<std::vector<int>> cells;  ///< nodes of each cell, in the order of the element's shape functions
  std::vector<double> materials = {};   ///< of each cell its number in Mesh::materials; empty: one
};

/// @throws InputError on several processes.
NodalSolution at_own_nodes(const ElasticSystem& system, std::optional<Law> law, const ElasticAnswer& answer,
                           const DofVector& displacement);

/// Means over the cells of each material but the body's own.
std::vector<RegionMeans> measure_regions(const ElasticSystem& system, const ElasticAnswer& answer,
                                         const DofVector& displacement);

struct VolumeMeasure {
  double change = 0;              ///< integral of det(I + grad u) - 1, divided by V
  double change_first_order = 0;  ///< integral of div u, divided by V
  double min_jacobian = 1;        ///< min det(I + grad u) at quadrature points
};

VolumeMeasure measure_volume(const Body3& body, const dealii::DoFHandler<3>& dof_handler,
                             const DofVector& displacement);

}  // namespace springproof::fem
