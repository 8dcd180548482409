#include "comparisons/run/time_left.h"

#include <algorithm>

#include "comparisons/run/voxel_reference.h"

namespace springproof {
namespace {

// Seconds of one core per unknown.  Assembled matrices: tetrahedra, and cubes without a multigrid hierarchy.
constexpr double matrix_free = 5e-6, with_matrices = 6e-5, springs = 5e-6;
constexpr double breaking = 1e-4;                            // of a sample that dries: hundreds of equilibria
constexpr double with_pressures = 4, pressures_above = 0.4;  // factor above this Poisson's ratio
constexpr double start_up = 0.3;                             // of the programs
constexpr double large_strain = 25;  // number of linear systems in all load steps and Newton steps

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

double block_seconds(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  double total = 0;
  for (const std::string& element : e.reference.elements)
    for (const int divisor : {4, 2, 1}) {
      Cells cells = prepared.reference_cells;
      for (int& n : cells) n = std::max(1, n / divisor);
      total += seconds_of(element, unknowns(cells, degree_of(element)));
    }
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
    if (!e.cost && mesh->hexahedra.size() <= most_refined_cubes) total += with_matrices * 9 * unknowns(*mesh, 2);
  }
  return total;
}

}  // namespace

double expected_seconds(const PreparedCase& prepared, const IsotropicMaterial& material) {
  const Experiment& e = prepared.experiment;
  double total = e.body.is_voxels() ? voxel_seconds(prepared) : block_seconds(prepared);
  for (const Lattice& lattice : prepared.lattices)
    if (small_enough(e, *lattice.mesh))
      for (const ModelParameters& model : prepared.models)
        total += (e.fracture ? breaking * e.fracture->seeds : springs * model.seeds) * unknowns(*lattice.mesh, 1);
  const double incompressible = material.poisson_ratio > pressures_above ? with_pressures : 1;
  return start_up + total * incompressible * (e.model_kinematics() == Kinematics::finite ? large_strain : 1);
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
