#include "comparisons/prepare/voxel_body.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "comparisons/judge/measures.h"
#include "comparisons/prepare/load_resultants.h"
#include "comparisons/prepare/refined_lattice.h"
#include "comparisons/prepare/region_notes.h"
#include "meshes/locate/facet_tree.h"
#include "meshes/locate/locate.h"
#include "meshes/mesher/mesher.h"
#include "meshes/patches/rim.h"
#include "meshes/patches/select_patches.h"
#include "meshes/quality.h"
#include "meshes/regions/mark_regions.h"
#include "meshes/volume.h"
#include "meshes/voxels/voxelise.h"
#include "problem/case_file/measures.h"
#include "problem/system/progress.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

// Tetrahedra of the finest mesh: with quadratic elements 100,000 unknowns, some five seconds of one core.  At large
// strain a third of them, which take a minute.
constexpr int finest_tetrahedra = 20000, finest_at_large_strain = 7000;
constexpr double finer_at_rims = 4;  // edges of the finest mesh over those where held patches end on a smooth surface

MeshRequest body_request(const PreparedCase& prepared) {
  MeshRequest request;
  request.file = prepared.body.geo;
  request.size = prepared.experiment.body.size;
  request.scale = prepared.experiment.body.scale;
  request.volumes = volumes_of(prepared.experiment.regions);
  return request;
}

/// Hint for files in millimetres that are read as metres, or converted twice; empty if the size is plausible.
std::string scale_hint(const Mesh& mesh, const Body& body) {
  constexpr double large = 10, small = 1e-3;  // [m]
  const double span = (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).maxCoeff();
  if (body.is_script()) return {};
  if (body.scale != 1 && body.states_its_unit() && (span > large || span < small))
    return fmt::format(
        "the body spans {:.3g} m: a STEP file states its unit, and scale = {:g} multiplies that; is scale "
        "one too many?",
        span, body.scale);
  if (body.scale == 1 && span > large)
    return fmt::format(
        "the body spans {:.3g} m; did you forget scale = 0.001, or units = \"mm\" at the top of the file?", span);
  return span < small ? fmt::format("the body spans {:.3g} m; is it so small?", span) : "";
}

/// Where the body is, and how large.
std::string size_note(const Mesh& body, Units units) {
  const Vec3 low = body.nodes.colwise().minCoeff().transpose(), high = body.nodes.colwise().maxCoeff().transpose();
  const Named unit = unit_in(units, "m");
  const Vec3 size = (high - low) / unit.in_si;
  return fmt::format("the body is {:.4g} x {:.4g} x {:.4g} {}, from {} to {}, and of {:.6g} {}³", size[0], size[1],
                     size[2], unit.name, text(low, units), text(high, units),
                     volume(body, body.nodes) / std::pow(unit.in_si, 3), unit.name);
}

/// Edges of a mesh over those of the finest one.
double coarseness(const Mesh& mesh, const PreparedCase& prepared) {
  return std::cbrt(prepared.body.uncut.back() / static_cast<double>(mesh.tetrahedra.size()));
}

/// Edges at a rim are the shorter the finer the mesh: what they cost falls with the square of the mesh's edges, as
/// all else does.
/// @param uncut its tetrahedra before patches were cut
std::vector<std::string> refine_rims(const PreparedCase& prepared, int uncut, Mesh& mesh) {
  const Experiment& e = prepared.experiment;
  if (e.reference.elements.empty() || e.model_kinematics() == Kinematics::finite) return {};
  const double edge = edge_of_regular(volume(mesh, mesh.nodes), uncut);
  const double coarser = std::cbrt(static_cast<double>(prepared.body.uncut.back()) / uncut);
  std::vector<std::string> held = supported_patches(e);
  for (const PatchRule& rule : e.patches)  // by normals: ragged, on noise as long as the surface is large
    if (rule.facing) std::erase(held, rule.name);
  const std::size_t before = mesh.tetrahedra.size();
  refine_rims(held, edge * coarser / finer_at_rims, mesh);
  if (mesh.tetrahedra.size() == before) return {};
  return {fmt::format("held patches end on a smooth surface: {} tetrahedra cut into {} there", before,
                      mesh.tetrahedra.size())};
}

/// Facets that leave out a share of a smooth body's volume make it twice as much softer in bending and torsion.
double chords(const MeshedBody& body) {
  constexpr double most = 0.2;  // beyond, a part of the solid was meshed
  if (!(body.smooth_volume > 0)) return 0;
  const double share = 2 * std::abs(volume(body.mesh, body.mesh.nodes) / body.smooth_volume - 1);
  return share < most ? share : 0;
}

void mesh_the_body(MeshRequest request, PreparedCase& prepared, std::string& hint) {
  const Experiment& e = prepared.experiment;
  request.edge = e.reference.edge;
  const bool large_strain = e.model_kinematics() == Kinematics::finite && !e.dynamics;
  request.tetrahedra = large_strain ? finest_at_large_strain : finest_tetrahedra;
  const bool alone = e.reference.elements.empty() && !e.reference.in_time;
  if (!alone) request.coarser = {reference_ratios.begin(), reference_ratios.end()};
  MeshedBody body = alone ? mesh_to_cut(request) : mesh_body(request);
  prepared.body.notes = {size_note(body.mesh, prepared.experiment.units)};
  prepared.body.note(body.notes);
  hint = scale_hint(body.mesh, e.body);
  if (!hint.empty()) prepared.body.notes.push_back(hint);
  prepared.body.chords = chords(body);
  if (!body.facets.triangles.empty()) prepared.body.facets = std::make_shared<Surface>(std::move(body.facets));
  body.coarser.push_back(std::move(body.mesh));
  for (const Mesh& mesh : body.coarser) prepared.body.uncut.push_back(static_cast<int>(mesh.tetrahedra.size()));
  for (std::size_t m = 0; m < body.coarser.size(); ++m) {
    Mesh& mesh = body.coarser[m];
    const double coarser = coarseness(mesh, prepared);
    std::vector<std::string> notes = mark_regions(e.regions, coarser, mesh);
    for (std::string& note : select_patches(e.patches, mesh, coarser)) notes.push_back(std::move(note));
    for (std::string& note : refine_rims(prepared, prepared.body.uncut[m], mesh)) notes.push_back(std::move(note));
    if (m + 1 == body.coarser.size()) prepared.body.note(notes);
    prepared.body.tetrahedra.push_back(std::make_shared<Mesh>(std::move(mesh)));
  }
  if (!e.regions.empty()) prepared.body.of_regions = prepared.body.tetrahedra.back();
}

std::vector<double> voxel_edges(const Body& body, double volume) {
  if (!body.voxel_edges.empty()) return body.voxel_edges;
  std::vector<double> edges;
  for (const int count : body.voxel_counts) edges.push_back(std::cbrt(volume / count));
  return edges;
}

/// @throws std::invalid_argument, before the work, if more cubes fill the body than a lattice may have.
void check_counts(const std::vector<double>& edges, double volume) {
  constexpr double most_cubes = 4e6;
  for (const double edge : edges)
    if (const double cubes = volume / std::pow(edge, 3); !(cubes < 1.1 * most_cubes))
      throw std::invalid_argument(
          fmt::format("voxels: about {:.3g} cubes of {:.3g} m fill the body (allowed: up to {:.0g}; a lattice takes "
                      "some 3 kB per cube); "
                      "take larger voxels",
                      cubes, edge, most_cubes));
}

/// Whether some model takes whole cubes.
bool takes_whole_cubes(const PreparedCase& prepared) {
  return std::ranges::any_of(prepared.models, [](const auto& p) { return !p.cut.value_or(false); });
}

/// @throws std::invalid_argument if the cubes fill more than twice or less than half of the body's volume.
void compare_volumes(double cubes, double edge, double body, std::vector<std::string>& notes) {
  const double share = cubes * std::pow(edge, 3) / body;
  const std::string says =
      fmt::format("{} cubes of {:.6g} m fill {:.4g} times the volume of the body", cubes, edge, share);
  if (share > 2 || share < 0.5)
    throw std::invalid_argument("voxels: " + says + " (allowed: 0.5 to 2); take smaller voxels");
  if (std::abs(share - 1) > 0.1) notes.push_back(says + ": its thin parts are not resolved");
}

/// Tetrahedral meshes as fine as the lattices, for elements compared with the models and networks on their vertices.
void mesh_like_lattices(MeshRequest request, PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  const auto on_vertices = [](const ModelParameters& p) { return passes_patch_test(p.row); };
  if (elements_of(e, 'p').empty() && std::ranges::none_of(prepared.models, on_vertices)) return;
  for (Lattice& lattice : prepared.lattices) {
    request.edge = lattice.voxel_edge;
    Mesh mesh = mesh_body(request).mesh;
    const double coarser = coarseness(mesh, prepared);
    mark_regions(e.regions, coarser, mesh);
    select_patches(e.patches, mesh, coarser);
    lattice.tetrahedra = std::make_shared<Mesh>(std::move(mesh));
  }
}

/// Which models take the cut cells.
std::string cut_cells_note(const PreparedCase& prepared, const CutBody& cut) {
  std::vector<std::string> cut_models, others;
  for (std::size_t m = 0; m < prepared.models.size(); ++m)
    (*prepared.models[m].cut ? cut_models : others).push_back(prepared.experiment.models[m].label);
  int largest = 1;
  for (const CutCell& c : cut.cells) largest = std::max(largest, c.size);
  const std::string sizes = largest > 1 ? fmt::format("{:.4g} to {:.4g}", cut.grid.edge, largest * cut.grid.edge)
                                        : fmt::format("{:.6g}", cut.grid.edge);
  std::string note = fmt::format("{} cells of {} m, cut along the true surface: {}", cut.cells.size(), sizes,
                                 fmt::join(cut_models, ", "));
  if (!others.empty()) note += fmt::format("; whole cubes: {}", fmt::join(others, ", "));
  return note;
}

/// What was promised for what was asked.
std::string refinement_note(const RefinedBody& refined, double accuracy) {
  return fmt::format(
      "{} cells, refined where the stress is least certain, promise a displacement error of {:.2g} %; {:.3g} % "
      "were asked for{}",
      refined.cut.cells.size(), 100 * refined.promised(), 100 * accuracy,
      refined.reached ? "" : ", which smaller cells than these would take");
}

/// Measures the cells of a lattice for all models and materials that need it, and notes how far they are off.
/// @throws std::invalid_argument where averaged springs are as good.
void measure_lattice(PreparedCase& prepared, Lattice& lattice) {
  lattice.measured = to_be_measured(prepared, lattice);
  std::set<const MeasuredBody*> noted;
  for (const ModelParameters& p : prepared.models)
    for (const IsotropicMaterial& material : prepared.experiment.materials) {
      if (!p.coarsened.value_or(false)) continue;
      const MeasuredBody& measured = lattice.measured->measured(p, material);
      if (noted.insert(&measured).second) prepared.body.notes.push_back(describe(measured));
    }
}

/// The cells of a body.
/// @throws InputError at its smallest region, where one has no cell.
CutBody cut_with_regions(const Experiment& e, const VoxelGrid& grid, const Mesh& body) try {
  if (!e.regions.empty()) require_resolved(e.regions, body, grid.edge);
  return cut_body(grid, body);
} catch (const std::invalid_argument& error) {
  if (!std::string_view(error.what()).starts_with("voxels: material")) throw;
  refuse_smallest(e.regions, body, grid.edge);
}

void cut_lattices(PreparedCase& prepared) {
  const Mesh& true_body = *prepared.body.tetrahedra.back();
  const auto region = std::make_shared<Region>(region_of(true_body));
  prepared.body.size = region->upper - region->lower;
  const std::vector<double> edges = voxel_edges(prepared.experiment.body, region->volume);
  check_counts(edges, region->volume);
  const auto add_cubes = [&](const VoxelGrid& grid) {
    Voxels voxels = voxelise(grid, true_body);
    prepared.body.note(voxels.notes);
    const auto cubes = static_cast<double>(voxels.mesh.hexahedra.size());
    if (takes_whole_cubes(prepared)) compare_volumes(cubes, grid.edge, region->volume, prepared.body.notes);
    add_lattice({grid.cells, std::make_shared<Mesh>(std::move(voxels.mesh)), grid.edge, region}, prepared);
  };
  Refinement refinement(prepared, voxel_grid(true_body, edges.front()), true_body);
  for (const double accuracy : prepared.experiment.body.accuracies) {
    RefinedBody refined = refinement.until(accuracy);
    std::vector<Lattice>& lattices = prepared.lattices;
    if (!lattices.empty() && lattices.back().cut->cells.size() == refined.cut.cells.size()) continue;  // promised, too
    const auto cells = static_cast<double>(refined.cut.cells.size());
    const VoxelGrid cubes = voxel_grid(true_body, std::cbrt(region->volume / cells));  // for results, and whole cubes
    if (!lattices.empty() && lattices.back().cells == cubes.cells) lattices.pop_back();
    add_cubes(cubes);
    prepared.body.note({refinement_note(refined, accuracy), cut_cells_note(prepared, refined.cut)});
    prepared.body.note(refined.cut.notes);
    lattices.back().estimated = refined.estimated;
    lattices.back().falls_short = refined.falls_short;
    lattices.back().cut = std::make_shared<CutBody>(std::move(refined.cut));
  }
  if (!prepared.experiment.body.accuracies.empty()) return;
  for (const double edge : edges) {
    const VoxelGrid grid = voxel_grid(true_body, edge);
    progress::detail(fmt::format("voxels of {:.4g} m", edge));
    add_cubes(grid);
    const auto is_cut = [](const ModelParameters& p) { return p.cut.value_or(false); };
    if (std::ranges::none_of(prepared.models, is_cut)) continue;
    CutBody cut = cut_with_regions(prepared.experiment, grid, true_body);
    prepared.body.notes.push_back(cut_cells_note(prepared, cut));
    if (!prepared.experiment.regions.empty() && edge == edges.back())
      prepared.body.note(region_notes(prepared.experiment.regions, true_body, edge));
    prepared.body.note(cut.notes);
    prepared.lattices.back().cut = std::make_shared<CutBody>(std::move(cut));
    const auto is_measured = [](const ModelParameters& p) { return p.coarsened.value_or(false); };
    if (std::ranges::any_of(prepared.models, is_measured)) measure_lattice(prepared, prepared.lattices.back());
  }
}

/// Requests displacements at lattice nodes in the body; for those outside at the nearest surface point and at the
/// mirror image.
void place_samples(PreparedCase& prepared) {
  const Mesh& body = *prepared.body.tetrahedra.back();
  const std::vector<OuterFacet> facets = outer_facets(body);
  const FacetTree tree(body, facets);
  const Region& region = *prepared.lattices.front().region;
  std::vector<Vec3> points;
  const auto ask = [&](const Vec3& p) {
    points.push_back(p);
    return static_cast<int>(points.size()) - 1;
  };
  for (const Lattice& lattice : prepared.lattices)
    for (const auto& row : lattice.mesh->nodes.rowwise()) {
      const Vec3 X = row.transpose();
      if (region.inside(X)) {
        prepared.samples.of_nodes.push_back({ask(X)});
        continue;
      }
      const Vec3 nearest = tree.nearest(X).point, mirrored = 2 * nearest - X;
      const int at = ask(nearest);
      prepared.samples.of_nodes.push_back({at, region.inside(mirrored) ? ask(mirrored) : at});
    }
  prepared.samples.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    prepared.samples.points.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
}

/// How far a curved surface may lie above a facet of it [m]: half of how far the corners of the facets beside it lie
/// below its plane, unless there is an edge of the body between them.
double bulge(const Mesh& body, const std::vector<OuterFacet>& facets, std::size_t of) {
  constexpr double edge = 0.7;  // cosine between normals
  const auto corners = [&](const OuterFacet& f) {
    return std::array<Vec3, 3>{body.nodes.row(f.nodes[0]), body.nodes.row(f.nodes[1]), body.nodes.row(f.nodes[2])};
  };
  const auto normal = [&](const OuterFacet& f) -> Vec3 {
    const auto [a, b, c] = corners(f);
    const Vec3 n = (b - a).cross(c - a).normalized();
    return n.dot(f.cell_centre - a) > 0 ? Vec3(-n) : n;
  };
  const Vec3 n = normal(facets[of]), at = corners(facets[of])[0];
  double below = 0;
  for (const OuterFacet& f : facets)
    if (std::find_first_of(f.nodes.begin(), f.nodes.begin() + 3, facets[of].nodes.begin(),
                           facets[of].nodes.begin() + 3) != f.nodes.begin() + 3 &&
        normal(f).dot(n) > edge)
      for (const Vec3& corner : corners(f)) below = std::max(below, n.dot(at - corner));
  return below / 2;
}

/// Notes probes outside the body: beyond its facets by more than round-off and than its surface may bulge over them.
/// @throws InputError naming a probe that is further outside than half a cube.
void check_probes(PreparedCase& prepared) {
  const Mesh& body = *prepared.body.tetrahedra.back();
  const Units units = prepared.experiment.units;
  const std::vector<OuterFacet> facets = outer_facets(body);
  const FacetTree tree(body, facets);
  const auto finer = [](const Lattice& a, const Lattice& b) { return a.voxel_edge < b.voxel_edge; };
  const double slack = std::ranges::min_element(prepared.lattices, finer)->voxel_edge / 2;
  for (const Probe& p : prepared.experiment.probes) {
    if (prepared.lattices.front().region->inside(p.at)) continue;
    const auto [facet, point, distance] = tree.nearest(p.at);
    if (distance > 1e-6 * prepared.body.size.norm() + bulge(body, facets, facet))
      prepared.body.notes.push_back(fmt::format("probe '{}' lies {} outside the body: its displacement is extrapolated",
                                                p.name, text(distance, units, "m", 3)));
    if (distance > slack)
      throw InputError(fmt::format("probe '{}': {}: the point {} lies outside the body, {} from its surface; {}",
                                   p.name, key_in(units, "at_m").name, text(p.at, units), text(distance, units, "m", 3),
                                   size_note(body, units)));
  }
}

void prepare_body(PreparedCase& prepared, std::string& hint) {
  const Experiment& e = prepared.experiment;
  const MeshRequest request = body_request(prepared);
  mesh_the_body(request, prepared, hint);
  std::vector<std::string> patches;
  for (const Patch& p : prepared.body.tetrahedra.back()->patches) patches.push_back(p.name);
  check_patches(e, patches);
  cut_lattices(prepared);
  mesh_like_lattices(request, prepared);
  set_resultants(prepared);
  check_probes(prepared);
  if (!e.reference.elements.empty()) place_samples(prepared);
}

}  // namespace

std::shared_ptr<MeasuredLattice> to_be_measured(const PreparedCase& prepared, const Lattice& lattice) {
  if (lattice.cut->cells.size() > most_measured_cells)
    throw std::invalid_argument(fmt::format(
        "coarsened: {} cells take longer to measure than a finer lattice to solve (allowed: up to {}); take larger "
        "cells, or averaged springs",
        lattice.cut->cells.size(), most_measured_cells));
  std::set<std::string> held;  // along all axes; what a support leaves free is measured free
  for (const Load& load : prepared.loads) {
    if (!prescribes_displacement(load)) continue;
    const PrescribedValue value = prescribed_displacement(load, Vec3::Zero(), Kinematics::linear);
    if (value[0] && value[1] && value[2]) held.insert(*patch_of(load));
  }
  return std::make_shared<MeasuredLattice>(lattice.cut, prepared.body.tetrahedra.back(),
                                           std::vector<std::string>(held.begin(), held.end()),
                                           materials_of(prepared.experiment.regions));
}

void prepare_voxel_body(PreparedCase& prepared) {
  std::string hint;
  const auto with_hint = [&](const std::exception& e) {
    return hint.empty() ? std::string(e.what()) : fmt::format("{}; {}", e.what(), hint);
  };
  try {
    prepare_body(prepared, hint);
    if (!hint.empty()) to_stderr("note: {}: {}\n", prepared.experiment.file.string(), hint);
  } catch (const InputError& e) {
    if (hint.empty()) throw;
    throw InputError(with_hint(e));
  } catch (const std::invalid_argument& e) {
    throw InputError(prepared.experiment.body.where, with_hint(e));
  }
}

}  // namespace springproof
