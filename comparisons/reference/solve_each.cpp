#include "comparisons/reference/solve_each.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "fem_reference/exchange/exchange.h"
#include "fem_reference/exchange/reference.h"
#include "problem/files/files.h"
#include "problem/processes/child.h"
#include "problem/system/json.h"

namespace springproof {
namespace {

// CPU seconds per unknown, as measured in the default run.  Assembled matrices: tetrahedra, and cubes without a
// multigrid hierarchy.
constexpr double matrix_free = 1.5e-5, with_matrices = 3e-5;
constexpr double fem_step = 6e-6;                              // of a motion, per unknown and step, of 10,000 unknowns
constexpr double with_pressures = 1.6, pressures_above = 0.4;  // factor above this Poisson's ratio
constexpr double start_up = 0.03;                              // of a run of the program
constexpr double of_large_strain = 5;  // of all load steps and Newton steps, whose systems are solved roughly

/// The request of one of its grids, with no other mesh than its own.
fem::Request of_grid(const fem::Request& all, std::size_t number) {
  fem::Request one = all;
  one.grids = {all.grids[number]};
  fem::Discretisation& grid = one.grids.front();
  if (grid.mesh < 0) return one;
  one.meshes = {all.meshes.at(grid.mesh)};
  grid.mesh = 0;
  return one;
}

/// Of the displacement, on a grid of the request: about three per node.
double unknowns_of(const fem::Request& request, const fem::Discretisation& grid) {
  const int degree = degree_of(grid.element);
  if (grid.mesh < 0) return unknowns(grid.cells, degree);
  return std::pow(8, grid.refinements) * grid.times_cells * unknowns(*request.meshes.at(grid.mesh), degree);
}

std::vector<std::size_t> coarsest_first(const fem::Request& request) {
  std::vector<std::size_t> order(request.grids.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> unknowns;
  for (const fem::Discretisation& grid : request.grids) unknowns.push_back(unknowns_of(request, grid));
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return unknowns[a] < unknowns[b]; });
  return order;
}

fem::Solution without_result(const fem::Request& request, const std::string& why) {
  fem::Solution none;
  none.grid = request.grids.front();
  none.law = request.law;
  none.message = why;
  return none;
}

/// Kept by all that the program is told.
fem::Solution solve_one(const fem::Request& request, const RunKeeper& keeper) {
  if (!keeper.keeps()) return fem::solve(request).front();
  return fem::solutions_from_json(keeper.run("grid-" + checksum(cbor(fem::to_json(request))), cost_of(request),
                                             [&] { return fem::to_json(fem::solve(request)); }))
      .front();
}

}  // namespace

double unknowns(const Cells& cells, int degree) {
  double nodes = 1;
  for (const int n : cells) nodes *= degree * n + 1.0;
  return 3 * nodes;
}

double unknowns(const Mesh& mesh, int degree) {
  const double added = mesh.hexahedra.empty() ? 7 : 8;
  return 3.0 * static_cast<double>(mesh.nodes.rows()) * (degree == 1 ? 1 : added);
}

int degree_of(const std::string& element) { return element[1] - '0'; }

double times_cells(const Experiment& e, const std::string& element) { return element == "p2" ? e.reference.refine : 1; }

double factor_of(const IsotropicMaterial& material, bool finite) {
  return (material.poisson_ratio > pressures_above ? with_pressures : 1) * (finite ? of_large_strain : 1);
}

RunCost grid_cost(double unknowns, bool assembled, double factor) {
  return {assembled ? RunKind::assembled : RunKind::matrix_free,
          start_up + (assembled ? with_matrices : matrix_free) * unknowns * factor};
}

RunCost cost_of(const fem::Request& request) {
  const fem::Discretisation& grid = request.grids.front();
  const double unknowns = unknowns_of(request, grid);
  if (request.motion) {  // larger systems take more iterations
    const double step = fem_step * unknowns * std::cbrt(unknowns / 1e4);
    return {RunKind::finite_elements_in_motion, start_up + step * grid.steps};
  }
  return grid_cost(unknowns, grid.mesh >= 0 || grid.element[0] == 'p',
                   factor_of(request.material, request.law != "linear"));
}

std::vector<fem::Solution> solve_each(const fem::Request& request, const RunKeeper& keeper, const Solved& solved) {
  std::vector<fem::Solution> solutions(request.grids.size());
  std::map<std::string, std::string> lost;  // elements that the program died of, and how
  std::map<std::pair<std::string, double>, bool> hopeless;
  std::exception_ptr first;
  std::size_t thrown = 0;
  for (const std::size_t g : coarsest_first(request)) {
    if (children_interrupted()) throw std::runtime_error("interrupted");
    fem::Request one = of_grid(request, g);
    const auto& [element, grading] = std::pair(request.grids[g].element, request.grids[g].grading);
    try {
      if (lost.contains(element))
        solutions[g] = without_result(one, lost.at(element)), ++thrown;
      else if (grading != 1 && hopeless[{element, grading}])
        solutions[g] = without_result(one, "not tried, as the coarser grid has no result");
      else
        solutions[g] = solve_one(one, keeper);
    } catch (const NoRoom&) {  // no fault of the case
      throw;
    } catch (const std::runtime_error& e) {
      if (!first) first = std::current_exception();
      lost[element] = e.what();
      solutions[g] = without_result(one, e.what());
      ++thrown;
    }
    solutions[g].grid = request.grids[g];
    hopeless[{element, grading}] |= !solutions[g].ok;
    if (solved && solutions[g].ok) solved(g, solutions[g]);
  }
  if (first && thrown == solutions.size()) std::rethrow_exception(first);
  return solutions;
}

}  // namespace springproof
