#include "comparisons/prepare/springs_of_case.h"

#include <fmt/format.h>

#include "msm/embedding/boundary.h"
#include "msm/embedding/supports.h"
#include "msm/measure/moduli.h"
#include "msm/models.h"
#include "msm/springs_of_model.h"

namespace springproof {
namespace {

/// The surface that is to be carried, without weights.
EmbeddedSurface surface_of(const PreparedCase& prepared, const Mesh* carried) {
  if (!carried)
    return surface_of_mesh(prepared.body.tetrahedra.empty() ? *prepared.lattices.front().mesh
                                                            : *prepared.body.tetrahedra.back());
  EmbeddedSurface surface;
  surface.vertices = carried->nodes;
  for (const auto& [a, b, c, none] : carried->patches.front().facets) surface.facets.push_back({a, b, c});
  return surface;
}

/// With the weights of cut cells.
EmbeddedSurface carried_surface(EmbeddedSurface surface, const CutBody& body) {
  const Carriers carriers = carriers_of(static_cast<int>(body.points.rows()), body.carried);
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < surface.vertices.rows(); ++v) {
    const CutBody::Place at = body.place(surface.vertices.row(v).transpose());
    for (int n = 0; n < 8; ++n)
      if (at.weights[n] != 0)
        for_each_carrier(carriers, body.cells[at.cell].corners[n],
                         [&](int node, double share) { entries.emplace_back(v, node, share * at.weights[n]); });
  }
  surface.weights.resize(surface.vertices.rows(), body.points.rows());
  surface.weights.setFromTriplets(entries.begin(), entries.end());
  return surface;
}

/// Whole cells, or a network without cells.
void add_network(const PreparedCase& prepared, const Mesh* carried, SpringsFile& file) {
  const Lattice& lattice = prepared.lattices.front();
  const ModelParameters& parameters = prepared.models.front();
  EmbeddedModel built = build_on(prepared, lattice, parameters, *file.material, false);
  file.grip = parameters.springs ? parameters.springs->grip : grip_of(parameters, *lattice.mesh);
  file.grip_from_cells =
      parameters.springs ? parameters.springs->grip_from_cells : parameters.row.topology != Topology::random;
  file.patches = built.embedding.held;
  file.surface = carried_surface(surface_of(prepared, carried), *lattice.mesh, built.model.network, built.embedding);
  file.model = std::move(built.model);
}

/// Cut cells.  Every node that nothing carries has a mass: anchors are kept apart.  Loads and weights of carried nodes
/// are handed to those that carry them.
void add_cut_network(const PreparedCase& prepared, const Mesh* carried, SpringsFile& file) {
  const Lattice& lattice = prepared.lattices.front();
  const CutBody& body = *lattice.cut;
  std::vector<IsotropicMaterial> materials = materials_of(prepared.experiment.regions);
  EmbeddedModel built = build_cut_on(lattice, prepared.models.front(), {}, *file.material, materials);
  materials.insert(materials.begin(), *file.material);
  attach(prepared.experiment.masses, *lattice.mesh, built.embedding, built.model.network);
  file.model = std::move(built.model);
  if (file.model.network.bonds.empty()) erase_laws<Anchors>(file.model);
  Embedding loads = embed(body, {}, file.model.network, Mesh{});
  file.loads = std::move(loads.patches);
  file.volumes = std::move(loads.volumes);
  hand_back(body.carried, file.volumes, 1);
  for (auto& [name, shares] : file.loads) {
    hand_back(body.carried, shares.area, 1);
    hand_back(body.carried, shares.normal);
  }
  for (const auto& [name, parts] : body.patches) file.anchors[name] = anchors_of_patch(body, name, materials);
  file.surface = carried_surface(surface_of(prepared, carried), body);
}

std::map<std::string, double> derived_of(const SpringsFile& file, const ModelParameters& parameters) {
  std::map<std::string, double> derived = springproof::derived_of(file);
  if (!parameters.springs) {
    const MeasuredModuli m = measure_moduli(parameters, *file.material);
    derived.merge(std::map<std::string, double>{{"measured_youngs_modulus_Pa", m.youngs_modulus},
                                                {"measured_poisson_ratio", m.poisson_ratio},
                                                {"measured_shear_modulus_Pa", m.shear_modulus}});
  }
  return derived;
}

}  // namespace

SpringsFile springs_of(const PreparedCase& prepared, const Mesh* carried) {
  const ModelParameters& parameters = prepared.models.front();
  const ModelChoice& choice = prepared.experiment.models.front();
  for (const AttachedMass& mass : prepared.experiment.masses)
    if (!mass.weighs)
      throw InputError(
          fmt::format("mass '{}': is inertia alone, and the masses of a springs file have weight too "
                      "(allowed: weighs = true)",
                      mass.name));
  SpringsFile file;
  file.material = prepared.experiment.materials.front();
  file.density = file.material->density;
  for (const MaterialRegion& r : prepared.experiment.regions) file.regions.push_back({r.name, r.material});
  parameters.cut.value_or(false) ? add_cut_network(prepared, carried, file) : add_network(prepared, carried, file);
  file.origin = {"springproof " SPRINGPROOF_VERSION, choice.name, choice.options,
                 prepared.experiment.text.empty() ? prepared.body.geo.filename().string()
                                                  : prepared.experiment.file.filename().string(),
                 input_checksum(prepared.experiment)};
  if (parameters.cut.value_or(false)) file.origin.options["cut"] = true;  // not what the name says: averaged springs
  file.relaxing = RelaxingCells::of(file.model, *file.material, prepared.experiment.relaxation);
  file.derived = derived_of(file, parameters);
  return file;
}

}  // namespace springproof
