#include "comparisons/prepare/prepared_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "meshes/mesher/mesh_cache.h"
#include "meshes/mesher/mesher.h"
#include "msm/dynamics/time_step.h"
#include "msm/embedding/boundary.h"
#include "msm/exchange/anchored_springs.h"
#include "msm/vertex_models.h"
#include "problem/files/files.h"

namespace springproof {

namespace {

/// Lets anchors act along the axes along which the loads hold their patch.
void release_axes(const std::vector<Load>& loads, const std::map<std::string, std::vector<int>>& held,
                  Network& network) {
  if (network.anchors.empty()) return;
  std::map<int, int> axes;  // of a node, in bits
  for (const Load& load : loads) {
    if (!prescribes_displacement(load)) continue;
    const PrescribedValue value = prescribed_displacement(load, Vec3::Zero(), Kinematics::linear);
    for (const int node : held.at(*patch_of(load)))
      for (int d = 0; d < 3; ++d) axes[node] |= int(value[d].has_value()) << d;
  }
  for (Anchor& a : network.anchors)
    for (int d = 0; d < 3; ++d)
      if ((axes.at(a.node) >> d & 1) == 0) a.release(d);
}

/// @throws InputError unless the file has, of each patch of the loads, what the case needs.
EmbeddedModel from_file_of_cut_cells(const PreparedCase& prepared, const ModelParameters& parameters,
                                     const Lattice& lattice, const std::set<std::string>& held, bool in_motion) try {
  const SpringsFile& file = *parameters.springs;
  for (const Load& load : prepared.loads)
    if (const std::string* on = patch_of(load); on && !(file.loads.contains(*on) && file.anchors.contains(*on)))
      throw InputError(fmt::format("/loads or /anchors: has no patch '{}', on which the case has a load", *on));
  auto [model, embedding] = anchored(file, held, *lattice.mesh);
  if (in_motion) embedding.surface = file.surface.weights;
  return {std::move(model), std::move(embedding)};
} catch (const InputError& e) {
  throw InputError(fmt::format("{}: {}", parameters.row.name, e.what()));
}

/// On the vertices of the lattice's tetrahedra, with results at the nodes of its cubes.
EmbeddedModel build_on_tetrahedra(const Lattice& lattice, const ModelParameters& parameters,
                                  const IsotropicMaterial& material) {
  const Mesh& tetrahedra = *lattice.tetrahedra;
  EmbeddedModel built = build_on_vertices(parameters, tetrahedra, material, lattice.fits->of(parameters, tetrahedra));
  built.embedding.weights = embed(*lattice.mesh, built.model.network, 0).weights;
  return built;
}

/// @throws InputError if a springs file has other masses attached than the case.
void attach_masses(const Experiment& e, const Mesh& mesh, EmbeddedModel& built) {
  Network& network = built.model.network;
  const double of_file = network.attached.sum();
  attach(e.masses, mesh, built.embedding, network);
  const double of_case = network.attached.sum();
  if (of_file > 0 && std::abs(of_file - of_case) > 1e-6 * of_file)
    throw InputError(
        fmt::format("/nodes/attached_kg: the springs file has {:.6g} kg attached to the body, the case "
                    "{:.6g} kg (needed: the same, by [[mass]])",
                    of_file, of_case));
}

/// On the lattice as the model takes it.
EmbeddedModel built_on(const PreparedCase& prepared, const Lattice& lattice, const ModelParameters& parameters,
                       const std::set<std::string>& held, const IsotropicMaterial& material, bool in_motion) {
  if (parameters.springs && parameters.springs->model.network.cells.cut()) {
    require_material(parameters, material);
    return from_file_of_cut_cells(prepared, parameters, lattice, held, in_motion);
  }
  if (passes_patch_test(parameters.row) && lattice.tetrahedra)
    return build_on_tetrahedra(lattice, parameters, material);
  const std::vector<IsotropicMaterial> regions = materials_of(prepared.experiment.regions);
  if (!parameters.cut.value_or(false))
    return build_embedded(parameters, *lattice.mesh, material, lattice.region.get(), regions);
  return build_cut_on(lattice, parameters, {held.begin(), held.end()}, material, regions);
}

/// Or may take them.
bool takes_explicit_steps(const std::optional<MotionChoice>& motion) {
  return !motion || motion->integrator == "explicit" || motion->integrator == "auto";
}

}  // namespace

std::string input_checksum(const Experiment& e) {
  std::string all = checksum(e.text);
  const auto add = [&](const std::filesystem::path& file) {
    all += file.filename().string() + checksum(text_of_file(file));
  };
  for (const auto& file : files_behind(find_geo(e.body, e.file))) add(file);
  for (const MaterialRegion& region : e.regions)
    if (const auto* in = std::get_if<EnclosedPlace>(&region.place)) add(in->file);
  for (const std::filesystem::path& history : e.histories) add(history);
  for (const ModelChoice& model : e.models)
    if (!model.file.empty()) add(model.file);
  return checksum(all);
}

const Network& FittedNetworks::of(const ModelParameters& parameters, const Mesh& tetrahedra) {
  const std::scoped_lock lock(one_at_a_time_);
  const double key = parameters.random.springs_per_node;
  const auto known = by_springs_per_node_.find(key);
  if (known != by_springs_per_node_.end()) return known->second;
  return by_springs_per_node_.emplace(key, fitted_on_vertices(parameters, tetrahedra)).first->second;
}

PreparedCase at_setting(const PreparedCase& prepared, std::size_t setting) {
  PreparedCase one = prepared;
  one.experiment = prepared.experiment.at(setting);
  return one;
}

EmbeddedModel build_cut_on(const Lattice& lattice, const ModelParameters& parameters,
                           const std::vector<std::string>& held, const IsotropicMaterial& material,
                           const std::vector<IsotropicMaterial>& regions) {
  ModelParameters averaged = parameters;
  averaged.coarsened = false;
  if (!parameters.coarsened.value_or(false))
    return build_cut(averaged, *lattice.cut, held, *lattice.mesh, material, regions);
  EmbeddedModel built = build_cut(averaged, lattice.measured->cells(), held, *lattice.mesh, material);
  lattice.measured->apply(parameters, material, held, built);
  return built;
}

const CutBody& cells_of(const Lattice& lattice, const ModelParameters& parameters) {
  return parameters.coarsened.value_or(false) ? lattice.measured->cells() : *lattice.cut;
}

EmbeddedModel build_on(const PreparedCase& prepared, const Lattice& lattice, const ModelParameters& parameters,
                       const IsotropicMaterial& material, bool in_motion) {
  std::set<std::string> held;
  for (const Load& load : prepared.loads)
    if (prescribes_displacement(load)) held.insert(*patch_of(load));
  EmbeddedModel built = built_on(prepared, lattice, parameters, held, material, in_motion);
  release_axes(prepared.loads, built.embedding.held, built.model.network);
  attach_masses(prepared.experiment, *lattice.mesh, built);
  if (in_motion && takes_explicit_steps(prepared.experiment.dynamics)) soften_bonds(built.model, material.density);
  if (in_motion && held.empty()) {  // in flight all nodes fall alike
    built.embedding.free_fall = true;
    if (!built.embedding.patches.empty()) built.embedding.volumes = built.model.network.volume;
  }
  return built;
}

void add_lattice(Lattice lattice, PreparedCase& prepared) {
  lattice.first_node = prepared.nodes();
  prepared.lattices.push_back(std::move(lattice));
}

std::vector<Load> lattice_loads(const PreparedCase& prepared) {
  std::vector<Load> loads = prepared.loads;
  std::erase_if(loads, [](const Load& load) { return std::holds_alternative<FieldBodyForce>(load); });
  return loads;
}

std::size_t finest_lattice(const PreparedCase& prepared) {
  const auto& all = prepared.lattices;
  const auto finer = [](const Lattice& a, const Lattice& b) {
    return a.mesh->hexahedra.size() < b.mesh->hexahedra.size();
  };
  return static_cast<std::size_t>(std::ranges::max_element(all, finer) - all.begin());
}

std::vector<std::string> elements_of(const Experiment& e, char shape) {
  std::vector<std::string> elements;
  if (!e.models.empty())
    std::ranges::copy_if(e.elements, std::back_inserter(elements),
                         [&](const std::string& name) { return name[0] == shape; });
  return elements;
}

bool small_enough(const Experiment& experiment, const Mesh& mesh, int degree) {
  const double unknowns = 3.0 * static_cast<double>(mesh.nodes.rows()) * degree * degree * degree;
  return experiment.max_unknowns == 0 || unknowns <= experiment.max_unknowns;
}

}  // namespace springproof
