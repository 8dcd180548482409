#include "comparisons/run/expected_runs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "comparisons/models/motion_reference.h"
#include "comparisons/reference/reference_grids.h"
#include "comparisons/reference/solve_each.h"
#include "comparisons/reference/voxel_reference.h"
#include "comparisons/run/prepare.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

// CPU seconds per unknown, as measured on the shipped cases.
constexpr double springs = 2.5e-6, springs_of_bodies = 1.2e-5, springs_at_random = 3.5e-5, springs_fitted = 4e-3;
constexpr double large_strain = 20, near_incompressible = 0.025;  // factors; the second is divided by 1 - 2 nu
constexpr double spring_step = 2e-8;                              // of a motion, per unknown and step
constexpr double breaking = 1e-4;                                 // of a sample that dries: hundreds of equilibria
constexpr double homogenisation = 0.1;                            // of a random network, whatever its size
constexpr double refining = 4;                                    // [s] to an accuracy, once for all parts
constexpr double measuring = 8e-3;                                // [s] of a cube's cells in finer ones
constexpr int reference_grids = 3;

// Bodies of voxels before they are meshed.
constexpr double nodes_per_cube = 1.3, cubes_of_a_file = 2000, share_of_the_box = 0.5;
constexpr double nodes_of_tetrahedra = 6000;  // of the three meshes that the program chooses

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

  /// On a lattice of so many unknowns and cells of this edge [m].
  RunCost model(const ModelChoice& choice, double unknowns, double edge) const {
    if (is_external(choice)) return {RunKind::springs, 0};
    const ModelParameters p = resolve(choice);
    if (e_.fracture) return {RunKind::springs_at_random, breaking * e_.fracture->seeds * unknowns};
    if (choice.in_motion)
      return {RunKind::springs_in_motion, spring_step * steps_of(*e_.dynamics, material_, edge) * p.seeds * unknowns};
    if (passes_patch_test(p.row) && e_.body.is_voxels())  // once for all parts
      return {RunKind::springs_fitted, springs_fitted * unknowns / static_cast<double>(e_.materials.size())};
    if (p.row.topology == Topology::random) {
      if (p.node_density) unknowns *= *p.node_density * std::pow(edge, 3);
      return {RunKind::springs_at_random, p.seeds * (homogenisation + springs_at_random * unknowns)};
    }
    if (e_.model_kinematics() == Kinematics::finite)
      return {RunKind::springs_at_large_strain,
              springs * unknowns * large_strain * (1 + near_incompressible / (1 - 2 * material_.poisson_ratio))};
    return {RunKind::springs, (e_.body.is_voxels() ? springs_of_bodies : springs) * unknowns * factor_};
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
    for (const auto& mesh : prepared.body.tetrahedra)
      runs.grid(times_cells(e, element) * unknowns(*mesh, degree_of(element)), true);
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

bool measures_cells(const Experiment& e) {
  return std::ranges::any_of(e.models, [&](const ModelChoice& choice) {
    return !is_external(choice) && resolve(choice).coarsened.value_or(e.body.coarsened);
  });
}

/// Edge [m] of the cells of a lattice that is not meshed yet; of a file, whose size is not known, infinite.
double unmeshed_edge(const Body& body, std::size_t lattice) {
  if (!body.voxel_edges.empty()) return body.voxel_edges[std::min(lattice, body.voxel_edges.size() - 1)];
  const double volume = (body.is_voxels() ? share_of_the_box : 1) * body.size.prod();
  return volume > 0 ? std::cbrt(volume / cubes_of(body, lattice)) : std::numeric_limits<double>::infinity();
}

double unmeshed_unknowns(const Body& body, std::size_t lattice, int degree) {
  if (!body.is_voxels()) return unknowns(body.cells[lattice], degree);
  return 3 * nodes_per_cube * cubes_of(body, lattice) * (degree == 1 ? 1 : 8);
}

std::vector<RunCost> expected_variations(const Experiment& e) {
  std::vector<RunCost> runs;
  for (const Variation& variation : variations(e)) runs.push_back(cost_of_variation(case_of(e, variation)));
  return runs;
}

template <class T, class Before>
void keep_first(std::vector<T>& all, Before before) {
  if (!all.empty()) all = {*std::ranges::min_element(all, before)};
}

}  // namespace

std::vector<Variation> variations(const Experiment& e) {
  std::vector<Variation> all;
  if (e.measured.empty()) return all;
  for (std::size_t c = 0; c < e.load_cases.size(); ++c)
    for (std::size_t i = 0; i <= e.inputs.size(); ++i)
      if (c > 0 || i > 0) all.push_back({c, i > 0 ? std::optional(i - 1) : std::nullopt});
  return all;
}

Experiment case_of(const Experiment& e, const Variation& variation) {
  Experiment changed = varied(e, variation);
  if (changed.models.size() > 1) changed.models.resize(1);
  if (!variation.input) return changed;
  changed.elements.clear();
  changed.reference.elements.clear();
  keep_first(changed.body.cells, [](const Cells& a, const Cells& b) { return cell_count(a) < cell_count(b); });
  keep_first(changed.body.voxel_counts, std::less<>());
  for (auto* numbers : {&changed.body.voxel_edges, &changed.body.accuracies}) keep_first(*numbers, std::greater<>());
  return changed;
}

RunCost cost_of_variation(const Experiment& e) {
  return {RunKind::of_variations, unmeshed_seconds(e, e.materials.front())};
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
  for (const RunCost& run : expected_variations(e)) runs.all.push_back(run);
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
    if (allowed(nodal))
      for (const ModelChoice& model : e.models) runs.all.push_back(runs.model(model, nodal, unmeshed_edge(e.body, i)));
  }
  if (e.reference.in_time && !voxels) {
    PreparedCase unmeshed;
    unmeshed.experiment = e;
    add_grids_in_time(unmeshed, material, runs);
  }
  double lattices = refining * static_cast<double>(e.body.accuracies.size()) / static_cast<double>(e.materials.size());
  for (std::size_t i = 0; i < e.body.resolutions() && measures_cells(e); ++i)
    lattices += measuring * cubes_of(e.body, i);
  return sum_of(runs.all) + sum_of(expected_variations(e)) + lattices;
}

}  // namespace springproof
