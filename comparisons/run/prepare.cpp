#include "comparisons/run/prepare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "comparisons/judge/measures.h"
#include "comparisons/models/external.h"
#include "comparisons/models/motion_run.h"
#include "comparisons/prepare/case_checks.h"
#include "comparisons/prepare/sampling.h"
#include "comparisons/prepare/voxel_body.h"
#include "comparisons/reference/reference_grids.h"
#include "comparisons/results/records.h"
#include "comparisons/run/choose_models.h"
#include "meshes/locate/locate.h"
#include "meshes/mesher/mesher.h"
#include "meshes/patches/select_patches.h"
#include "meshes/regions/mark_regions.h"
#include "meshes/volume.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"
#include "problem/case_file/measures.h"
#include "problem/processes/child.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

// Elements of the finest reference grid (Q2): what one core can solve in a few seconds.
constexpr double linear_reference_elements = 4096;
constexpr double finite_reference_elements = 1000;

// Largest number of cells of a lattice whose matrices fit into a workstation's memory.
constexpr double largest_lattice = 4e6;

/// @throws InputError at the model's location in the case, if its options yield no network.
EmbeddedModel build_chosen(const PreparedCase& prepared, const Lattice& lattice, std::size_t number,
                           const IsotropicMaterial& material) try {
  return build_on(prepared, lattice, prepared.models[number], material, prepared.experiment.models[number].in_motion);
} catch (const InputError& e) {
  throw InputError(prepared.experiment.models[number].where, fmt::format("compare.models: {}", e.what()));
}

/// False for a case of motions alone that start from rest: bodies may fly.
bool needs_supports(const Experiment& e) { return !e.dynamics || e.dynamics->equilibrium || e.dynamics->released; }

/// Builds the model and applies the loads, to find errors in either.
void try_model(const PreparedCase& prepared, const Lattice& lattice, std::size_t number) try {
  const Experiment& experiment = prepared.experiment;
  if (is_external(experiment.models[number])) return;
  const ModelParameters& parameters = prepared.models[number];
  const Mesh& mesh = *lattice.mesh;
  const auto [model, embedding] = build_chosen(prepared, lattice, number, experiment.materials.front());
  if (experiment.models[number].in_motion)
    for (std::size_t s = 0; s < experiment.settings().size(); ++s) {  // refuses unsafe ones
      const PreparedCase at = at_setting(prepared, s);
      const IsotropicMaterial& material = at.experiment.body_material(s);
      steps_of(at.experiment, build_chosen(at, lattice, number, material).model, material);
    }
  if (parameters.row.topology == Topology::cells && !*parameters.cut) return;
  const BoundaryConditions bc =
      transfer(prepared.loads, mesh, embedding, model.network, 1000, experiment.model_kinematics());
  if (!parameters.hold_rigid_motions && needs_supports(experiment)) require_supported(bc, model.network.X);
} catch (const InputError&) {
  throw;
} catch (const std::runtime_error&) {
  // No network with this material's moduli: the run will report it.
}

/// @throws InputError for a lattice too large for a workstation's memory.
void check_fineness(const Body& body, const Cells& c) {
  if (const double total = double(c[0]) * c[1] * c[2]; total > largest_lattice)
    throw InputError(
        body.where,
        fmt::format("cells: {} x {} x {} = {:.3g} cells (allowed: up to {:.0g}; a lattice takes some 3 kB per cell)",
                    c[0], c[1], c[2], total, largest_lattice));
}

/// Notes the regions.
/// @throws InputError at a [[patch]] or [[region]] whose border is no line of one of the reference's grids.
void check_grids_of_reference(PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  if ((e.patches.empty() && e.regions.empty()) || (e.reference.elements.empty() && !e.reference.in_time)) return;
  for (const int divisor : {4, 2, 1}) {
    Mesh mesh =
        mesh_geo(prepared.body.geo, e.body.size, divided(prepared.reference_cells, divisor), {}, volumes_of(e.regions));
    const std::vector<std::string> notes = mark_regions(e.regions, 1, mesh);
    if (divisor == 1) prepared.body.note(notes);
    select_whole_facets(e.patches, mesh);
    if (divisor == 1 && !e.regions.empty()) prepared.body.of_regions = std::make_shared<Mesh>(std::move(mesh));
  }
}

/// Marks the regions of a lattice; the finest shows them where there is no reference.
/// @throws InputError at a region whose border runs through its cells.
void mark_lattice(PreparedCase& prepared, Mesh& mesh) {
  const Experiment& e = prepared.experiment;
  if (e.regions.empty() || e.models.empty()) return;
  std::vector<std::string> notes = mark_regions(e.regions, 1, mesh);
  if (prepared.lattices.empty() && e.reference.elements.empty() && !e.reference.in_time) prepared.body.note(notes);
}

void prepare_blocks(PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  prepared.reference_cells = reference_cells(e);
  for (const Cells& cells : e.body.cells) check_fineness(e.body, cells);
  for (const Cells& cells : e.body.cells) {
    MeshedBody body =
        mesh_body({.file = prepared.body.geo, .size = e.body.size, .cells = cells, .volumes = volumes_of(e.regions)});
    if (prepared.lattices.empty()) prepared.body.notes = std::move(body.notes);
    mark_lattice(prepared, body.mesh);
    select_whole_facets(e.patches, body.mesh);
    add_lattice({cells, std::make_shared<Mesh>(std::move(body.mesh))}, prepared);
  }
  check_grids_of_reference(prepared);
  if (!e.regions.empty() && !prepared.body.of_regions)
    prepared.body.of_regions = prepared.lattices[finest_lattice(prepared)].mesh;
}

/// Samples the patches of the body itself, if their mean displacement is measured.
void sample_patches(PreparedCase& prepared) {
  const std::vector<std::string>& measures = prepared.experiment.measures;
  if (!wanted("mean_displacement", measures) && !wanted("turn", measures)) return;
  const bool voxels = prepared.experiment.body.is_voxels();
  prepared.samples.of_patches =
      samples_of_patches(voxels ? *prepared.body.tetrahedra.back() : *prepared.lattices[finest_lattice(prepared)].mesh);
}

/// @throws InputError for a body that starts behind the plane that it is to fall on: the true one if all models that
///   move are of cut cells.
void check_plane(const PreparedCase& prepared, const Lattice& lattice) {
  const Experiment& e = prepared.experiment;
  if (!e.dynamics || !e.dynamics->plane) return;
  bool all_cut = true;
  for (std::size_t m = 0; m < prepared.models.size(); ++m)
    all_cut = all_cut && (!e.models[m].in_motion || *prepared.models[m].cut);
  const Mesh& mesh = all_cut ? *prepared.body.tetrahedra.back() : *lattice.mesh;
  double nearest = std::numeric_limits<double>::infinity();
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n)
    nearest = std::min(nearest, e.dynamics->plane->distance(mesh.nodes.row(n).transpose()));
  const double size = (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).norm();
  if (nearest < -1e-9 * size)
    throw InputError(
        e.dynamics->where,
        fmt::format("dynamics.plane: the body reaches {:.3g} m behind it (allowed: a plane that the body is "
                    "in front of, or touches)",
                    -nearest));
}

/// @throws InputError for a mass that hangs on nothing.
void check_masses(const Experiment& e, const Mesh& mesh) {
  if (e.body.is_voxels()) return;  // whose cells may end below the surface
  const Locator locator(mesh);
  for (std::size_t m = 0; m < e.masses.size(); ++m)
    for (const Vec3& X : e.masses[m].at)
      if (!locator.find(X))
        throw InputError(
            e.mass_locations[m],
            fmt::format("mass '{}': at_m: the point ({:.6g}, {:.6g}, {:.6g}) m lies outside the body "
                        "(allowed: a point of the body, of {:.6g} x {:.6g} x {:.6g} m)",
                        e.masses[m].name, X[0], X[1], X[2], e.body.size[0], e.body.size[1], e.body.size[2]));
}

/// Checks patches, loads, models and measures of the case on one lattice.
void try_lattice(PreparedCase& prepared, const Lattice& lattice) {
  const Experiment& e = prepared.experiment;
  const Mesh& mesh = *lattice.mesh;
  std::vector<std::string> patches;
  for (const Patch& p : mesh.patches) patches.push_back(p.name);
  check_patches(e, patches);
  check_masses(e, mesh);
  check_mean_displacements(e, patches);
  check_plane(prepared, lattice);
  prepared.sharing = patches_sharing_supports(prepared.loads, mesh, e.model_kinematics());
  if ((needs_supports(e) || !e.reference.elements.empty()) &&
      std::ranges::none_of(prepared.models, [](const auto& p) { return p.hold_rigid_motions; }))
    try {
      require_supported(transfer(lattice_loads(prepared), mesh, 1000, e.model_kinematics()), mesh.nodes);
    } catch (const InputError& error) {
      if (needs_supports(e)) throw;
      throw InputError(fmt::format("{}, or name no elements in [reference]: finite elements at rest", error.what()));
    }
  for (std::size_t m = 0; m < prepared.models.size(); ++m)
    if (const Topology t = prepared.models[m].row.topology;
        t == Topology::cells || t == Topology::file || &lattice == &prepared.lattices.front())
      try_model(prepared, lattice, m);
  const NodalVectors u = NodalVectors::Zero(mesh.nodes.rows(), 3);
  if (e.section) section_distance(mesh, *e.section, u, u);
  at_measured_points(prepared, lattice, u);
}

double mass_of_body(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  const Mesh& mesh = prepared.body.of_regions ? *prepared.body.of_regions : *prepared.lattices.front().mesh;
  if (!prepared.body.of_regions) return e.materials.front().density * volume(mesh, mesh.nodes);
  const Eigen::VectorXd volumes = cell_volumes(mesh, mesh.nodes);
  double mass = 0;
  for (std::size_t c = 0; c < mesh.materials.size(); ++c)
    mass += volumes[static_cast<Eigen::Index>(c)] *
            (mesh.materials[c] == 0 ? e.materials.front() : e.regions[mesh.materials[c] - 1].material).density;
  return mass;
}

/// Notes masses that are many times as heavy as the body.
void note_heavy_masses(PreparedCase& prepared) {
  constexpr double many = 10;
  const double body = mass_of_body(prepared);
  for (const AttachedMass& mass : prepared.experiment.masses)
    if (mass.mass > many * body)
      prepared.body.notes.push_back(fmt::format("mass '{}' is {:.3g} times as heavy as the body, which has {:.3g} kg",
                                                mass.name, mass.mass / body, body));
}

/// Where a message about a physical volume belongs, which the mesher has without the lines of the case.
std::optional<SourceLocation> region_of_message(const Experiment& e, const std::string& message) {
  if (message.find("physical volume") == std::string::npos) return {};
  for (const MaterialRegion& r : e.regions)
    if (const auto* volume = std::get_if<std::string>(&r.place);
        volume && message.find("'" + *volume + "'") != std::string::npos)
      return r.where;
  return {};
}

/// Calls `prepare_it`; error messages name the case.
template <class Prepare>
PreparedCase naming(const Experiment& experiment, const Prepare& prepare_it) try {
  return prepare_it();
} catch (const NoRoom&) {  // no fault of the case
  throw;
} catch (const InputError& e) {
  const std::string message = e.what(), file = experiment.file.string();
  if (const auto where = region_of_message(experiment, message); where && !message.starts_with(file))
    throw InputError(*where, "region.volume: " + message);
  throw InputError(message.starts_with(file) ? message : file + ": " + message);
} catch (const std::runtime_error& e) {
  const std::string message = e.what(), file = experiment.file.string();
  throw std::runtime_error(message.starts_with(file) ? message : file + ": " + message);
}

}  // namespace

Cells reference_cells(const Experiment& e) {
  if (e.reference.cells[0] > 0) return e.reference.cells;
  const double elements =
      e.model_kinematics() == Kinematics::linear ? linear_reference_elements : finite_reference_elements;
  return divisible_cells(e.body.size, elements, fewest_across(e));
}

PreparedCase prepare_lattices(const Experiment& experiment) {
  return naming(experiment, [&] {
    PreparedCase prepared;
    prepared.experiment = experiment;
    prepared.loads = experiment.loads;
    prepared.body.size = experiment.body.size;
    choose_models(prepared);
    prepared.body.geo = find_geo(experiment.body, experiment.file);
    progress::phase("cutting the body");
    experiment.body.is_voxels() ? prepare_voxel_body(prepared) : prepare_blocks(prepared);
    check_own_regions(prepared);
    for (const Lattice& lattice : prepared.lattices) check_fineness(experiment.body, lattice.cells);
    if (experiment.body.is_voxels())
      check_supports(experiment, *prepared.body.tetrahedra.back());
    else if (!experiment.patches.empty())
      check_supports(experiment, *prepared.lattices.front().mesh);
    return prepared;
  });
}

PreparedCase prepare(const Experiment& experiment) {
  return naming(experiment, [&] {
    check_expectations(experiment);
    PreparedCase prepared = prepare_lattices(experiment);
    sample_patches(prepared);
    for (const Lattice& lattice : prepared.lattices) {
      progress::phase(fmt::format("trying loads and models on {} cells", cells_text(lattice.cells, " x ")));
      try_lattice(prepared, lattice);
    }
    for (std::size_t m = 0; m < prepared.models.size(); ++m)
      if (is_external(experiment.models[m])) check_external(prepared, m);
    note_heavy_masses(prepared);
    prepared.limits = lattice_limits(prepared);
    return prepared;
  });
}

}  // namespace springproof
