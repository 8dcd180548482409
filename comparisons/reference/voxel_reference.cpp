#include "comparisons/reference/voxel_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "comparisons/judge/measures.h"
#include "comparisons/prepare/load_resultants.h"
#include "comparisons/reference/solve_each.h"
#include "fem_reference/exchange/case_request.h"

namespace springproof {
namespace {

using Meshes = std::vector<std::shared_ptr<const Mesh>>;

/// Each element on each mesh, the meshes of one element one after the other.
std::vector<fem::Discretisation> grids_on(const Meshes& meshes, const std::vector<std::string>& elements) {
  std::vector<fem::Discretisation> grids;
  for (const std::string& element : elements)
    for (int m = 0; m < static_cast<int>(meshes.size()); ++m)
      grids.push_back({{static_cast<int>(meshes[m]->tetrahedra.size()), 0, 0}, element, 1.0, m, 0});
  return grids;
}

std::vector<fem::Solution> solve_tetrahedra(const PreparedCase& prepared, const IsotropicMaterial& material,
                                            const std::vector<fem::Discretisation>& grids, const Meshes& meshes,
                                            const RunKeeper& keeper, bool vtu_single = false,
                                            const CoarsestField& coarsest = {}) {
  if (grids.empty()) return {};
  const Experiment& e = prepared.experiment;
  const NodalVectors measured = measured_points(prepared);
  fem::Request request = fem::request_of(e, material);
  request.loads = prepared.loads;
  request.grids = grids;
  request.points = stacked(prepared.samples.points, measured);
  request.stress_points = stress_points(prepared);
  request.meshes = meshes;
  request.vtu_single = vtu_single;
  const auto to_lattices = [&](const fem::Solution& s) {
    return at_lattice_nodes(prepared, s.displacement.topRows(prepared.samples.points.rows()));
  };
  std::vector<fem::Solution> solutions = solve_each(request, keeper, [&](std::size_t g, const fem::Solution& s) {
    if (coarsest && g == 0) coarsest(to_lattices(s));
  });
  for (fem::Solution& s : solutions) {
    if (!s.ok) continue;
    const Mesh& own = *meshes[s.grid.mesh];
    s.reactions = about_true_patches(prepared, own, s.reactions);
    s.displacement = stacked(to_lattices(s), s.displacement.bottomRows(measured.rows()));
  }
  return solutions;
}

/// Solves on the cubes of one lattice: with these elements, and for the parts of the errors with q2, and q2 on cubes
/// cut into eight, if they are not too many.
std::vector<fem::Solution> solve_cubes(const PreparedCase& prepared, const Lattice& lattice,
                                       const IsotropicMaterial& material, const std::vector<std::string>& elements,
                                       const RunKeeper& keeper) {
  const Experiment& e = prepared.experiment;
  const auto& mesh = lattice.mesh;
  const Cells& cells = lattice.cells;
  if (mesh->hexahedra.size() > most_cubes) return {};
  fem::Request request = fem::request_of(e, material);
  request.loads = prepared.loads;
  request.points = mesh->nodes;
  request.meshes = {mesh};
  for (const std::string& element : elements) request.grids.push_back({cells, element, 1.0, 0, 0});
  if (e.parts && mesh->hexahedra.size() <= most_refined_cubes) {
    request.grids.push_back({cells, "q2", 1.0, 0, 0});
    request.grids.push_back({{2 * cells[0], 2 * cells[1], 2 * cells[2]}, "q2", 1.0, 0, 1});
  }
  if (request.grids.empty()) return {};
  std::vector<fem::Solution> solutions = solve_each(request, keeper);
  for (fem::Solution& s : solutions) {
    if (!s.ok) continue;
    s.reactions = about_true_patches(prepared, *mesh, s.reactions);
    NodalVectors of_lattices = NodalVectors::Zero(prepared.nodes(), 3);  // known at this one and at the measured points
    of_lattices.middleRows(lattice.first_node, mesh->nodes.rows()) = s.displacement;
    s.displacement = stacked(of_lattices, at_measured_points(prepared, lattice, s.displacement));
  }
  return solutions;
}

/// What facets of a smooth body may have done to a value of this size, unless it is less than a tenth of the error.
void add_facets(const PreparedCase& prepared, double size, ErrorSplit& split) {
  const double most = prepared.body.chords * size;
  if (most <= 0.1 * std::abs(split.total)) return;
  split.facets = most;
  split.uncertainty += most;
}

/// The total, in the mean over samples, and the parts that it is made of.
/// @param peer of eight-node elements on the same voxels, whose refinement has the limit; truth: the body-fitted limit
template <class Value, class Difference>
void set_parts(const std::vector<Value>& samples, const Value& peer, const Value& limit, const Value& truth,
               const Difference& difference, ErrorSplit& split) {
  for (const Value& sample : samples) {
    split.total += difference(sample, truth) / static_cast<double>(samples.size());
    split.model_error += difference(sample, peer) / static_cast<double>(samples.size());
  }
  split.discretisation_error = difference(peer, limit);
  split.geometry_error = difference(limit, truth);
}

/// The split of reaction_error; nothing where no support is moved.
std::optional<ErrorSplit> split_of_reactions(const PreparedCase& prepared, const VoxelLimit& voxels,
                                             const Reference& body,
                                             const std::vector<std::map<std::string, double>>& samples,
                                             ErrorSplit split) {
  const std::map<std::string, double> truth = values_of(body.scalars), limit = values_of(voxels.limits);
  const std::vector<std::string> patches = comparable_moved_patches(prepared);
  const double length = prepared.body.size.maxCoeff();
  const auto distance = [&](const auto& a, const auto& b) {
    const auto difference = reaction_difference(a, b, body.scalars, patches, length);
    return difference ? difference->error : 0;
  };
  if (samples.empty() || !reaction_difference(samples.front(), truth, body.scalars, patches, length)) return {};
  split.measure = "reaction_error";
  split.unit = unit_of(split.measure);
  set_parts(samples, voxels.peer_values, limit, truth, distance, split);
  split.uncertainty = distance(values_of(body.scalars, 1), truth);
  split.voxel_uncertainty = distance(values_of(voxels.limits, 1), limit);
  add_facets(prepared, 1, split);
  return split;
}

/// That meshes were cut where their error is largest.
std::string cut_note(double times, const std::vector<fem::Solution>& grids) {
  if (times == 1) return {};
  return fmt::format("cut into {}, {} and {} tetrahedra where their error is largest", grids[0].cells, grids[1].cells,
                     grids[2].cells);
}

}  // namespace

ReferenceGrids solve_body_grids(const PreparedCase& prepared, const IsotropicMaterial& material, const VtuOutput& vtu,
                                const RunKeeper& keeper, const CoarsestField& coarsest) try {
  ReferenceGrids out;
  const Experiment& e = prepared.experiment;
  std::vector<fem::Discretisation> grids = grids_on(prepared.body.tetrahedra, e.reference.elements);
  for (fem::Discretisation& grid : grids) {
    grid.times_cells = times_cells(e, grid.element);
    if (grid.mesh + 1 == static_cast<int>(prepared.body.tetrahedra.size()))
      grid.vtu = reference_file(vtu, grid.element, prepared.experiment.setting_of(material));
  }
  std::vector<fem::Solution> solutions =
      solve_tetrahedra(prepared, material, grids, prepared.body.tetrahedra, keeper, vtu.single, coarsest);
  for (fem::Solution& s : solutions) s.grid.cells[0] = prepared.body.uncut[s.grid.mesh];
  auto at = solutions.begin();
  for (const std::string& element : e.reference.elements) {
    out.elements.push_back({element, {at, at + 3}, cut_note(times_cells(e, element), {at, at + 3})});
    at += 3;
  }
  if (e.models.empty()) return out;
  const auto too_fine = [&](const Mesh& mesh, const std::string& element) {
    return !small_enough(e, mesh, degree_of(element));
  };
  Meshes fitted;
  for (const Lattice& lattice : prepared.lattices) {
    if (lattice.tetrahedra) fitted.push_back(lattice.tetrahedra);
    std::vector<std::string> on_cubes = elements_of(e, 'q');
    std::erase_if(on_cubes, [&](const std::string& element) { return too_fine(*lattice.mesh, element); });
    if (e.parts && std::ranges::find(on_cubes, "q1") == on_cubes.end()) on_cubes.push_back("q1");
    const std::vector<fem::Solution> cubes = solve_cubes(prepared, lattice, material, on_cubes, keeper);
    const auto refined = cubes.begin() + static_cast<std::ptrdiff_t>(std::min(on_cubes.size(), cubes.size()));
    out.peers.emplace_back(cubes.begin(), refined);
    out.refined.emplace_back(refined, cubes.end());
  }
  std::vector<fem::Discretisation> on_fitted = grids_on(fitted, elements_of(e, 'p'));
  std::erase_if(on_fitted, [&](const fem::Discretisation& grid) { return too_fine(*fitted[grid.mesh], grid.element); });
  for (const fem::Solution& s : solve_tetrahedra(prepared, material, on_fitted, fitted, keeper))
    out.peers[s.grid.mesh].push_back(s);
  return out;
} catch (const InputError&) {
  throw;
} catch (const std::runtime_error& e) {
  ReferenceGrids none;
  none.failure = e.what();
  return none;
}

std::optional<VoxelLimit> voxel_limit(const PreparedCase& prepared, std::size_t number, const ReferenceGrids& grids) {
  if (number >= grids.refined.size() || grids.refined[number].size() != 2) return {};
  const Lattice& lattice = prepared.lattices[number];
  const std::vector<fem::Solution>& peers = grids.peers[number];
  const auto q1 = std::ranges::find_if(peers, [](const fem::Solution& s) { return s.grid.element == "q1"; });
  const fem::Solution &h = grids.refined[number][0], &half = grids.refined[number][1];
  if (q1 == peers.end() || !q1->ok || !h.ok || !half.ok) return {};
  const fem::Solution& peer = *q1;
  const NodalVectors u1 = at_nodes(lattice, h.displacement), u2 = at_nodes(lattice, half.displacement);
  VoxelLimit out{at_nodes(lattice, peer.displacement),
                 2 * u2 - u1,
                 3 * (u2 - u1).rowwise().norm(),
                 measures_of(prepared, peer),
                 {}};
  const auto coarse = measures_of(prepared, h), fine = measures_of(prepared, half);
  for (const auto& [measure, value] : fine) out.limits[measure] = extrapolate_two(coarse.at(measure), value);
  raise_to_usual(out.limits);
  return out;
}

void without_staircase(const ErrorSplit& of_cubes, ErrorSplit& split) {
  const bool signed_parts = split.measure != "displacement_error" && split.measure != "reaction_error";
  split.model_error = of_cubes.model_error;
  split.geometry_error = 0;
  split.discretisation_error =
      signed_parts ? split.total - split.model_error : std::max(0.0, split.total - split.model_error);
}

std::vector<ErrorSplit> split_error(const PreparedCase& prepared, const Lattice& lattice, const RunKey& key,
                                    const VoxelLimit& voxels, const Reference& body, const std::vector<NodalVectors>& u,
                                    const std::vector<std::map<std::string, double>>& values) {
  const Experiment& e = prepared.experiment;
  ErrorSplit blank;
  static_cast<RunKey&>(blank) = key;
  blank.voxel_edge_m = lattice.voxel_edge;
  std::vector<ErrorSplit> splits;

  const Eigen::VectorXd weights = nodal_volumes(*lattice.mesh);
  const double size = body.scale.mean;
  const auto distance = [&](const NodalVectors& a, const NodalVectors& b) {
    return weighted_norm(a - b, weights) / size;
  };
  ErrorSplit field = blank;
  field.measure = "displacement_error";
  field.unit = unit_of(field.measure);
  set_parts(u, voxels.peer, voxels.limit, body.field.displacement, distance, field);
  field.voxel_uncertainty = std::sqrt(weights.dot(voxels.nodal_uncertainty.cwiseAbs2()) / weights.sum()) / size;
  field.uncertainty = body.field.uncertainty;
  add_facets(prepared, 1, field);
  splits.push_back(field);

  if (const auto s = split_of_reactions(prepared, voxels, body, values, blank)) splits.push_back(*s);

  for (const auto& [measure, limit] : voxels.limits) {
    if (!wanted(measure, e.measures) || !comparable(prepared, measure) || !body.scalars.contains(measure)) continue;
    if (values.empty() || !values.front().contains(measure)) continue;
    ErrorSplit s = blank;
    s.measure = measure;
    s.unit = unit_of(measure);
    const ReferenceValue& truth = body.scalars.at(measure);
    std::vector<double> of_samples;
    for (const auto& sample : values) of_samples.push_back(sample.at(measure));
    set_parts(of_samples, voxels.peer_values.at(measure), limit.value, truth.value, std::minus<>(), s);
    s.voxel_uncertainty = limit.uncertainty;
    s.uncertainty = truth.uncertainty;
    add_facets(prepared, std::abs(truth.value), s);
    splits.push_back(s);
  }
  return splits;
}

}  // namespace springproof
