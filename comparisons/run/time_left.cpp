#include "comparisons/run/time_left.h"

#include <algorithm>
#include <cmath>

#include "comparisons/run/prepare.h"
#include "comparisons/run/reference_grids.h"
#include "comparisons/run/voxel_reference.h"
#include "problem/case_file/external.h"

namespace springproof {
namespace {

// Seconds of one core per unknown.  Assembled matrices: tetrahedra, and cubes without a multigrid hierarchy.
constexpr double matrix_free = 5e-6, with_matrices = 6e-5, springs = 5e-6;
constexpr double breaking = 1e-4;                            // of a sample that dries: hundreds of equilibria
constexpr double with_pressures = 4, pressures_above = 0.4;  // factor above this Poisson's ratio
constexpr double start_up = 0.3;                             // of the programs
constexpr double large_strain = 25;  // number of linear systems in all load steps and Newton steps

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

double seconds_of(const std::string& element, double unknowns) {
  return unknowns * (element[0] == 'p' ? with_matrices : matrix_free);
}

int degree_of(const std::string& element) { return element[1] - '0'; }

double grid_seconds(const Experiment& e, const Cells& finest) {
  double total = 0;
  for (const std::string& element : e.reference.elements)
    for (const int divisor : {4, 2, 1})
      total += seconds_of(element, unknowns(divided(finest, divisor), degree_of(element)));
  return total;
}

double block_seconds(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  double total = grid_seconds(e, prepared.reference_cells);
  if (e.models.empty()) return total;
  for (const Lattice& lattice : prepared.lattices)
    for (const std::string& element : e.elements)
      if (small_enough(e, *lattice.mesh, degree_of(element)))
        total += seconds_of(element, unknowns(*lattice.mesh, degree_of(element)));
  return total;
}

double voxel_seconds(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  double total = 0;
  for (const std::string& element : e.reference.elements)
    for (const auto& mesh : prepared.tetrahedra) total += with_matrices * unknowns(*mesh, degree_of(element));
  if (e.reference.elements.empty() || e.models.empty()) return total;
  for (const Lattice& lattice : prepared.lattices) {
    const Mesh* mesh = lattice.mesh.get();
    if (lattice.tetrahedra)
      for (const std::string& element : elements_of(e, 'p'))
        total += with_matrices * unknowns(*lattice.tetrahedra, degree_of(element));
    if (mesh->hexahedra.size() > most_cubes) continue;
    for (const std::string& element : elements_of(e, 'q'))
      if (small_enough(e, *mesh, degree_of(element))) total += with_matrices * unknowns(*mesh, degree_of(element));
    if (e.parts && mesh->hexahedra.size() <= most_refined_cubes) total += with_matrices * 9 * unknowns(*mesh, 2);
  }
  return total;
}

/// Of a lattice that is not meshed yet.
double unknowns(const Body& body, std::size_t lattice, int degree) {
  if (!body.is_voxels()) return unknowns(body.cells[lattice], degree);
  double cubes = cubes_of_a_file;
  if (!body.voxel_counts.empty())
    cubes = body.voxel_counts[std::min(lattice, body.voxel_counts.size() - 1)];
  else if (body.is_script())
    cubes = share_of_the_box * body.size.prod() /
            std::pow(body.voxel_edges[std::min(lattice, body.voxel_edges.size() - 1)], 3);
  return 3 * nodes_per_cube * cubes * (degree == 1 ? 1 : 8);
}

/// Springs on a lattice with so many unknowns.
double spring_seconds(const Experiment& e, int seeds, double unknowns) {
  return (e.fracture ? breaking * e.fracture->seeds : springs * seeds) * unknowns;
}

double at_material(const Experiment& e, const IsotropicMaterial& material, double seconds) {
  const double incompressible = material.poisson_ratio > pressures_above ? with_pressures : 1;
  return start_up + seconds * incompressible * (e.model_kinematics() == Kinematics::finite ? large_strain : 1);
}

}  // namespace

double expected_seconds(const PreparedCase& prepared, const IsotropicMaterial& material) {
  const Experiment& e = prepared.experiment;
  double total = e.body.is_voxels() ? voxel_seconds(prepared) : block_seconds(prepared);
  for (const Lattice& lattice : prepared.lattices)
    if (small_enough(e, *lattice.mesh))
      for (const ModelParameters& model : prepared.models)
        total += spring_seconds(e, model.seeds, unknowns(*lattice.mesh, 1));
  return at_material(e, material, total);
}

double unmeshed_seconds(const Experiment& e, const IsotropicMaterial& material) {
  const bool voxels = e.body.is_voxels();
  const auto allowed = [&](double unknowns) { return e.max_unknowns == 0 || unknowns <= e.max_unknowns; };
  double total = voxels ? 0 : grid_seconds(e, reference_cells(e));
  if (voxels)
    for (const std::string& element : e.reference.elements)
      total += with_matrices * 3 * nodes_of_tetrahedra * (degree_of(element) == 1 ? 1 : 7);
  for (std::size_t i = 0; i < e.body.resolutions(); ++i) {
    const double nodal = unknowns(e.body, i, 1);
    if (!e.models.empty() && !(voxels && e.reference.elements.empty())) {
      for (const std::string& element : e.elements)
        if (const double n = unknowns(e.body, i, degree_of(element)); allowed(n))
          total += voxels ? with_matrices * n : seconds_of(element, n);
      if (voxels && e.parts && nodal <= 3 * nodes_per_cube * most_refined_cubes)
        total += with_matrices * 9 * unknowns(e.body, i, 2);
    }
    if (allowed(nodal))
      for (const ModelChoice& model : e.models)
        total += spring_seconds(e, is_external(model) ? 1 : resolve(model).seeds, nodal);
  }
  return at_material(e, material, total);
}

TimeLeft::TimeLeft(std::vector<double> expected, int jobs) : jobs_(std::max(1, jobs)) {
  for (const double e : expected) parts_.push_back({e});
}

void TimeLeft::started(std::size_t part, double now) {
  const std::lock_guard lock(mutex_);
  parts_[part].start = now;
}

void TimeLeft::finished(std::size_t part, double now) {
  const std::lock_guard lock(mutex_);
  parts_[part].took = now - *parts_[part].start;
}

void TimeLeft::kept(std::size_t part) {
  const std::lock_guard lock(mutex_);
  parts_[part] = {0, 0.0, 0.0};
}

/// Ratio of actual to expected time.
double TimeLeft::rate(double now) const {
  double took = 0, expected = 0, slowest = 0;
  for (const Part& p : parts_) {
    took += p.took.value_or(0);
    if (p.took) expected += p.expected;
    if (!p.took && p.start && p.expected > 0) slowest = std::max(slowest, (now - *p.start) / p.expected);
  }
  return std::max(expected > 0 ? took / expected : 1.0, slowest);
}

std::optional<double> TimeLeft::at(double now) const {
  const std::lock_guard lock(mutex_);
  const double rate = this->rate(now);
  double sum = 0, longest = 0;
  for (const Part& p : parts_) {
    if (p.took) continue;
    const double left = std::max(0.0, rate * p.expected - (p.start ? now - *p.start : 0));
    sum += left;
    longest = std::max(longest, left);
  }
  const double left = std::max(longest, sum / jobs_);
  if (left > 0) return left;
  return {};
}

}  // namespace springproof
