#include "comparisons/run/time_left.h"

#include <algorithm>
#include <cmath>

#include "comparisons/run/motion_reference.h"
#include "comparisons/run/prepare.h"
#include "comparisons/run/reference_grids.h"
#include "comparisons/run/voxel_reference.h"
#include "meshes/volume.h"
#include "problem/case_file/external.h"

namespace springproof {
namespace {

// Seconds of one core per unknown, as measured on idle cores.  Assembled matrices: tetrahedra, and cubes without a
// multigrid hierarchy.
constexpr double matrix_free = 1.5e-5, with_matrices = 3e-5, springs = 2.5e-6, springs_at_random = 3.5e-5;
constexpr double spring_step = 2e-8, fem_step = 6e-5;          // of a motion, per unknown and step
constexpr double breaking = 1e-4;                              // of a sample that dries: hundreds of equilibria
constexpr double with_pressures = 1.6, pressures_above = 0.4;  // factor above this Poisson's ratio
constexpr double start_up = 0.03;                              // of a run of the program
constexpr double large_strain = 25;  // number of linear systems in all load steps and Newton steps
constexpr int reference_grids = 3;

// Bodies of voxels before they are meshed.
constexpr double nodes_per_cube = 1.3, cubes_of_a_file = 2000, share_of_the_box = 0.5;
constexpr double nodes_of_tetrahedra = 6000;  // of the three meshes that the program chooses

double unknowns(const Cells& cells, int degree) {
  double nodes = 1;
  for (const int n : cells) nodes *= degree * n + 1.0;
  return 3 * nodes;
}

/// Of a mesh's nodes, with those that degree 2 adds on edges (of tetrahedra), faces and in cells.
double unknowns(const Mesh& mesh, int degree) {
  const double added = mesh.hexahedra.empty() ? 7 : 8;
  return 3.0 * static_cast<double>(mesh.nodes.rows()) * (degree == 1 ? 1 : added);
}

int degree_of(const std::string& element) { return element[1] - '0'; }

/// Of an equilibrium.
double factor_of(const IsotropicMaterial& material, bool finite) {
  return (material.poisson_ratio > pressures_above ? with_pressures : 1) * (finite ? large_strain : 1);
}

RunCost grid_cost(double unknowns, bool assembled, double factor) {
  return {assembled ? RunKind::assembled : RunKind::matrix_free,
          start_up + (assembled ? with_matrices : matrix_free) * unknowns * factor};
}

/// Of one network in motion, from the time that a pressure wave takes through half a cell.
double steps_of(const MotionChoice& motion, const IsotropicMaterial& m, double edge) {
  if (motion.time_step) return motion.duration / *motion.time_step;
  if (motion.integrator != "explicit") return motion.samples;
  const double speed = std::sqrt((bulk_modulus(m) + 4 * shear_modulus(m) / 3) / m.density);
  return 2 * motion.duration * speed / edge;
}

/// The runs of a part, from how many unknowns there are on what.
class Runs {
 public:
  Runs(const Experiment& e, const IsotropicMaterial& material)
      : e_(e), material_(material), factor_(factor_of(material, e.model_kinematics() == Kinematics::finite)) {}

  void grid(double unknowns, bool assembled) { all.push_back(grid_cost(unknowns, assembled, factor_)); }

  void grids_of_block(const Cells& finest) {
    for (const std::string& element : e_.reference.elements)
      for (const int divisor : {4, 2, 1})
        grid(unknowns(divided(finest, divisor), degree_of(element)), element[0] == 'p');
  }

  RunCost model(const ModelChoice& choice, double unknowns, double edge) const {
    if (is_external(choice)) return {RunKind::springs, 0};
    const ModelParameters p = resolve(choice);
    if (e_.fracture) return {RunKind::springs, breaking * e_.fracture->seeds * unknowns};
    if (choice.in_motion)
      return {RunKind::springs_in_motion, spring_step * steps_of(*e_.dynamics, material_, edge) * p.seeds * unknowns};
    const bool at_random = p.row.topology == Topology::random;
    return {RunKind::springs, (at_random ? springs_at_random : springs) * p.seeds * unknowns * factor_};
  }

  std::vector<RunCost> all;

 private:
  const Experiment& e_;
  const IsotropicMaterial& material_;
  const double factor_;
};

double edge_of(const Mesh& mesh) {
  const double cells = static_cast<double>(mesh.hexahedra.size() + mesh.tetrahedra.size());
  return std::cbrt(volume(mesh, mesh.nodes) / std::max(1.0, cells));
}

void add_block(const PreparedCase& prepared, Runs& runs) {
  const Experiment& e = prepared.experiment;
  runs.grids_of_block(prepared.reference_cells);
  if (e.models.empty()) return;
  for (const Lattice& lattice : prepared.lattices)
    for (const std::string& element : e.elements)
      if (small_enough(e, *lattice.mesh, degree_of(element)))
        runs.grid(unknowns(*lattice.mesh, degree_of(element)), element[0] == 'p');
}

void add_voxels(const PreparedCase& prepared, Runs& runs) {
  const Experiment& e = prepared.experiment;
  for (const std::string& element : e.reference.elements)
    for (const auto& mesh : prepared.tetrahedra) runs.grid(unknowns(*mesh, degree_of(element)), true);
  if (e.reference.elements.empty() || e.models.empty()) return;
  for (const Lattice& lattice : prepared.lattices) {
    const Mesh& mesh = *lattice.mesh;
    const auto add = [&](const Mesh& on, const std::string& element) {
      if (small_enough(e, mesh, degree_of(element))) runs.grid(unknowns(on, degree_of(element)), true);
    };
    if (lattice.tetrahedra)
      for (const std::string& element : elements_of(e, 'p')) add(*lattice.tetrahedra, element);
    if (mesh.hexahedra.size() > most_cubes) continue;
    for (const std::string& element : elements_of(e, 'q')) add(mesh, element);
    if (!e.parts || mesh.hexahedra.size() > most_refined_cubes) continue;
    for (const int times : {1, 8}) runs.grid(times * unknowns(mesh, 2), true);
  }
}

void add_grids_in_time(const PreparedCase& prepared, const IsotropicMaterial& material, Runs& runs) {
  const fem::Request request = motion_request(prepared, material);
  for (std::size_t g = 0; g < request.grids.size(); ++g) {
    fem::Request one = request;
    one.grids = {request.grids[g]};
    runs.all.push_back(cost_of(one));
  }
}

/// Of a lattice that is not meshed yet: its cubes.
double cubes_of(const Body& body, std::size_t lattice) {
  if (!body.is_voxels()) return cell_count(body.cells[lattice]);
  if (!body.voxel_counts.empty()) return body.voxel_counts[std::min(lattice, body.voxel_counts.size() - 1)];
  if (!body.is_script()) return cubes_of_a_file;
  return share_of_the_box * body.size.prod() /
         std::pow(body.voxel_edges[std::min(lattice, body.voxel_edges.size() - 1)], 3);
}

double unmeshed_unknowns(const Body& body, std::size_t lattice, int degree) {
  if (!body.is_voxels()) return unknowns(body.cells[lattice], degree);
  return 3 * nodes_per_cube * cubes_of(body, lattice) * (degree == 1 ? 1 : 8);
}

}  // namespace

double unknowns_of(const fem::Request& request, const fem::Discretisation& grid) {
  const int degree = degree_of(grid.element);
  if (grid.mesh < 0) return unknowns(grid.cells, degree);
  return std::pow(8, grid.refinements) * unknowns(*request.meshes.at(grid.mesh), degree);
}

RunCost cost_of(const fem::Request& request) {
  const fem::Discretisation& grid = request.grids.front();
  const double unknowns = unknowns_of(request, grid);
  if (request.motion) return {RunKind::finite_elements_in_motion, start_up + fem_step * unknowns * grid.steps};
  return grid_cost(unknowns, grid.mesh >= 0 || grid.element[0] == 'p',
                   factor_of(request.material, request.law != "linear"));
}

RunCost cost_of_model(const PreparedCase& prepared, const Lattice& lattice, std::size_t number,
                      const IsotropicMaterial& material) {
  const Experiment& e = prepared.experiment;
  return Runs(e, material).model(e.models[number], unknowns(*lattice.mesh, 1), edge_of(*lattice.mesh));
}

std::vector<RunCost> expected_runs(const PreparedCase& prepared, const IsotropicMaterial& material) {
  const Experiment& e = prepared.experiment;
  Runs runs(e, material);
  e.body.is_voxels() ? add_voxels(prepared, runs) : add_block(prepared, runs);
  if (e.reference.in_time) add_grids_in_time(prepared, material, runs);
  for (const Lattice& lattice : prepared.lattices)
    if (small_enough(e, *lattice.mesh))
      for (std::size_t m = 0; m < prepared.models.size(); ++m)
        runs.all.push_back(cost_of_model(prepared, lattice, m, material));
  return runs.all;
}

double sum_of(const std::vector<RunCost>& runs) {
  double sum = 0;
  for (const RunCost& run : runs) sum += run.seconds;
  return sum;
}

double unmeshed_seconds(const Experiment& e, const IsotropicMaterial& material) {
  const bool voxels = e.body.is_voxels();
  const auto allowed = [&](double unknowns) { return e.max_unknowns == 0 || unknowns <= e.max_unknowns; };
  Runs runs(e, material);
  if (!voxels) runs.grids_of_block(reference_cells(e));
  for (const std::string& element : voxels ? e.reference.elements : std::vector<std::string>())
    for (int grid = 0; grid < reference_grids; ++grid)
      runs.grid(3 * nodes_of_tetrahedra / reference_grids * (degree_of(element) == 1 ? 1 : 7), true);
  for (std::size_t i = 0; i < e.body.resolutions(); ++i) {
    const double nodal = unmeshed_unknowns(e.body, i, 1);
    if (!e.models.empty() && !(voxels && e.reference.elements.empty())) {
      for (const std::string& element : e.elements)
        if (const double n = unmeshed_unknowns(e.body, i, degree_of(element)); allowed(n))
          runs.grid(n, voxels || element[0] == 'p');
      if (voxels && e.parts && nodal <= 3 * nodes_per_cube * most_refined_cubes)
        for (const int times : {1, 8}) runs.grid(times * unmeshed_unknowns(e.body, i, 2), true);
    }
    const double edge = std::cbrt((voxels ? share_of_the_box : 1) * e.body.size.prod() / cubes_of(e.body, i));
    if (allowed(nodal))
      for (const ModelChoice& model : e.models) runs.all.push_back(runs.model(model, nodal, edge));
  }
  return sum_of(runs.all);
}

TimeLeft::TimeLeft(const std::vector<std::vector<RunCost>>& expected, int jobs)
    : parts_(expected.size()), jobs_(std::max(1, jobs)) {
  for (std::size_t part = 0; part < expected.size(); ++part)
    for (const RunCost& run : expected[part]) parts_[part].left[static_cast<std::size_t>(run.kind)] += run.seconds;
}

void TimeLeft::started(std::size_t part, double now) {
  const std::lock_guard lock(mutex_);
  parts_[part].since = now;
}

void TimeLeft::ran(std::size_t part, const RunCost& expected, std::optional<double> took, double now) {
  const std::lock_guard lock(mutex_);
  Part& p = parts_[part];
  const auto kind = static_cast<std::size_t>(expected.kind);
  p.left[kind] = std::max(0.0, p.left[kind] - expected.seconds);
  p.since = now;
  if (!took) return;
  for (Rate* rate : {&p.rates[kind], &rates_[kind]}) {
    rate->expected += expected.seconds;
    rate->took += *took;
  }
}

void TimeLeft::finished(std::size_t part) {
  const std::lock_guard lock(mutex_);
  parts_[part].left = {};
  parts_[part].since.reset();
}

double TimeLeft::Rate::beside(double otherwise) const {
  constexpr double weight = 1;  // [s]: runs as short as the start of a program say little
  return (weight * otherwise + took) / (weight + expected);
}

double TimeLeft::left_of(const Part& part, double now) const {
  double sum = 0;
  for (std::size_t kind = 0; kind < run_kinds; ++kind)
    sum += part.left[kind] * part.rates[kind].beside(rates_[kind].beside(1));
  if (!part.since) return sum;
  const double lasted = now - *part.since;
  return std::max(sum - lasted, lasted / 2);
}

std::optional<double> TimeLeft::at(double now) const {
  const std::lock_guard lock(mutex_);
  double sum = 0, longest = 0;
  for (const Part& p : parts_) {
    const double left = left_of(p, now);
    sum += left;
    longest = std::max(longest, left);
  }
  const double left = std::max(longest, sum / jobs_);
  if (left > 0) return left;
  return {};
}

}  // namespace springproof
