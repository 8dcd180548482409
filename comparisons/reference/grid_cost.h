// What a grid of finite elements is expected to take, from its number of unknowns.
#pragma once

#include <string>

#include "comparisons/reference/run_keeper.h"
#include "fem_reference/exchange/request.h"
#include "problem/case_file/experiment.h"

namespace springproof {

double unknowns(const Cells& cells, int degree);  ///< of a block's nodes

/// Of a mesh's nodes, with those that degree 2 adds on edges (of tetrahedra), faces and in cells.
double unknowns(const Mesh& mesh, int degree);

int degree_of(const std::string& element);  ///< 2 of "q2"

/// fem::Discretisation::times_cells of an element of [reference].
double times_cells(const Experiment& experiment, const std::string& element);

/// An equilibrium takes so many times as long as one of linear theory far from nu = 1/2.
double factor_of(const IsotropicMaterial& material, bool finite);

RunCost grid_cost(double unknowns, bool assembled, double factor);

/// Of the displacement, on a grid of the request: about three per node.
double unknowns_of(const fem::Request& request, const fem::Discretisation& grid);

/// What the first grid of the request is expected to take on one core.
RunCost cost_of(const fem::Request& request);

}  // namespace springproof
