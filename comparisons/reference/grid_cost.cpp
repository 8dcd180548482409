#include "comparisons/reference/grid_cost.h"

#include <cmath>

namespace springproof {
namespace {

// CPU seconds per unknown, as measured in the default run.  Assembled matrices: tetrahedra, and cubes without a
// multigrid hierarchy.
constexpr double matrix_free = 1.5e-5, with_matrices = 3e-5;
constexpr double fem_step = 6e-6;                              // of a motion, per unknown and step, of 10,000 unknowns
constexpr double with_pressures = 1.6, pressures_above = 0.4;  // factor above this Poisson's ratio
constexpr double start_up = 0.03;                              // of a run of the program
constexpr double large_strain = 5;  // of all load steps and Newton steps, whose systems are solved roughly

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
  return (material.poisson_ratio > pressures_above ? with_pressures : 1) * (finite ? large_strain : 1);
}

RunCost grid_cost(double unknowns, bool assembled, double factor) {
  return {assembled ? RunKind::assembled : RunKind::matrix_free,
          start_up + (assembled ? with_matrices : matrix_free) * unknowns * factor};
}

double unknowns_of(const fem::Request& request, const fem::Discretisation& grid) {
  const int degree = degree_of(grid.element);
  if (grid.mesh < 0) return unknowns(grid.cells, degree);
  return std::pow(8, grid.refinements) * grid.times_cells * unknowns(*request.meshes.at(grid.mesh), degree);
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

}  // namespace springproof
