#include "msm/models.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "meshes/materials.h"
#include "meshes/volume.h"
#include "msm/embedding/surface_shares.h"
#include "msm/exchange/springs_file.h"
#include "msm/laws/capabilities.h"
#include "msm/parameters/calibrate.h"
#include "msm/parameters/patch_fit.h"
#include "msm/periodic/laws_of_model.h"
#include "msm/topology/cubic_lattice.h"
#include "msm/topology/lattices_without_cells.h"
#include "msm/vertex_models.h"

namespace springproof {
namespace {

using enum Topology;

/// Edge [m] of a cube of the mesh, or of a cube with the volume of its mean cell.
double mean_edge(const Mesh& mesh) {
  const auto cells = static_cast<double>(mesh.hexahedra.size() + mesh.tetrahedra.size());
  return mesh.grid ? mesh.grid->spacing.maxCoeff() : std::cbrt(volume(mesh, mesh.nodes) / cells);
}

/// @throws InputError if the cells are boxes and the model is one of cubes.
void require_cubes(const ModelRow& row, const Mesh& mesh) {
  const bool of_cubes = row.topology == cells || row.topology == centres;
  if (!of_cubes || can(row, Capability::cells_of_any_shape) || !mesh.grid || has_cubes(*mesh.grid)) return;
  std::vector<std::string> names;
  for (const ModelRow& other : model_table())
    if (can(other, Capability::cells_of_any_shape)) names.push_back(other.name);
  const Vec3& edge = mesh.grid->spacing;
  throw InputError(
      fmt::format("{}: needs cubes; the cells are {:.6g} x {:.6g} x {:.6g} m (allowed: cells in proportion to the "
                  "size, or a model of boxes: {})",
                  row.name, edge[0], edge[1], edge[2], fmt::join(names, ", ")));
}

Network network_of(const ModelParameters& p, const Mesh& mesh, const Region* region) {
  switch (p.row.topology) {
    case cells:
      return can(p.row, Capability::cells_of_any_shape) ? lattice_without_springs(mesh)
                                                        : cubic_lattice(mesh, isotropic_pattern(p.face_to_cube));
    case centres:
      return p.turned == 0 ? node_lattice(mesh, isotropic_pattern(p.face_to_cube))
                           : node_lattice(region ? *region : region_of(mesh), cube_edge(mesh), p.turned,
                                          isotropic_pattern(p.face_to_cube));
    case hexagonal:
      return hexagonal_lattice(mesh, mean_edge(mesh));
    case random:
    case file:
      break;
  }
  RandomParameters random = p.random;
  random.spacing = p.node_density ? std::cbrt(1 / *p.node_density) : mean_edge(mesh);
  return random_network(region ? *region : region_of(mesh), random);
}

std::string box_words(const NodalVectors& x) {
  const auto corner = [](const Eigen::RowVector3d& v) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", v[0], v[1], v[2]);
  };
  return fmt::format("{} to {} m", corner(x.colwise().minCoeff()), corner(x.colwise().maxCoeff()));
}

/// @throws InputError unless the boxes of the mesh and of the network agree to two distances of nodes, and each node of
///   the mesh has one of the network as near.
void require_reached(const std::string& name, const Mesh& mesh, const Network& network, const Embedding* embedding) {
  const double reach = 2 * std::cbrt(network.volume.sum() / network.nodes());
  const double low = (mesh.nodes.colwise().minCoeff() - network.X.colwise().minCoeff()).cwiseAbs().maxCoeff();
  const double high = (mesh.nodes.colwise().maxCoeff() - network.X.colwise().maxCoeff()).cwiseAbs().maxCoeff();
  if (network.triangles.empty() && !(std::max(low, high) <= reach))
    throw InputError(
        fmt::format("{}: /nodes/position_m: the network reaches from {}, the body from {} (allowed: ends "
                    "that differ by up to two distances of nodes, {:.3g} m)",
                    name, box_words(network.X), box_words(mesh.nodes), reach));
  if (!embedding || !network.triangles.empty()) return;
  for (int m = 0; m < mesh.nodes.rows(); ++m) {
    double nearest = std::numeric_limits<double>::infinity();
    for (decltype(embedding->weights)::InnerIterator at(embedding->weights, m); at; ++at)
      nearest = std::min(nearest, (network.X.row(at.col()) - mesh.nodes.row(m)).norm());
    if (!(nearest <= reach))
      throw InputError(
          fmt::format("{}: /nodes/position_m: the body at ({:.4g}, {:.4g}, {:.4g}) m is {:.3g} m from the "
                      "nearest node of the network (allowed: up to {:.3g} m)",
                      name, mesh.nodes(m, 0), mesh.nodes(m, 1), mesh.nodes(m, 2), nearest, reach));
  }
}

/// @throws InputError unless the volumes of the mesh and of the network differ by up to a factor of two.
void require_volume(const std::string& name, const Mesh& mesh, const Network& network) {
  const double of_mesh = volume(mesh, mesh.nodes), own = network.volume.sum();
  if (!(own < 2 * of_mesh && own > of_mesh / 2))
    throw InputError(
        fmt::format("{}: /nodes/mass_kg: the masses over the density make {:.4g} m^3, the body has {:.4g} m^3 "
                    "(allowed: half of it to twice)",
                    name, own, of_mesh));
}

EmbeddedModel build_from_file(const ModelParameters& p, const Mesh& mesh, const IsotropicMaterial& material,
                              const Region* region) {
  require_material(p, material);
  EmbeddedModel built;
  built.model = p.springs->model;
  const Network& network = built.model.network;
  require_reached(p.row.name, mesh, network, nullptr);
  require_volume(p.row.name, mesh, network);
  const double grip = p.grip ? mean_edge(mesh) * *p.grip : p.springs->grip;
  built.embedding = embed_at_nodes(mesh, network, grip, p.springs->grip_from_cells ? nullptr : region);
  require_reached(p.row.name, mesh, network, &built.embedding);
  return built;
}

/// Fits the springs of a disordered network to the patch test at every node.  If the mesh is the body itself (no
/// region), its loads are shared by the nodes as the surface is.  Returns the outward area of each node [m^2].
NodalVectors fit_in_body(const Mesh& mesh, const Region* region, double shear_modulus, EmbeddedModel& built) {
  Network& network = built.model.network;
  SurfaceShares shares = surface_shares(region ? *region : region_of(mesh), network);
  fit_patch(shares.area, shear_modulus, network);
  if (!region) {
    built.embedding.patches = std::move(shares.patches);
    built.embedding.volumes = built.embedding.weights.transpose() * nodal_volumes(mesh);
  }
  return shares.area;
}

/// Adds the laws of another material to those of the body's own, which are of the same kinds.
void add_region(const std::vector<ForceLaw>& of_region, std::vector<ForceLaw>& laws) {
  for (std::size_t i = 0; i < laws.size(); ++i)
    std::visit(
        [&](auto& law) {
          if constexpr (requires { law.regions; })
            law.regions.push_back(std::get<std::decay_t<decltype(law)>>(of_region[i]));
        },
        laws[i]);
}

/// Gives the cells of a calibrated lattice of material 0 the materials of the mesh's.
void add_materials(const ModelParameters& p, const Mesh& mesh, const std::vector<IsotropicMaterial>& materials,
                   MassSpringModel& model) {
  Network& network = model.network;
  network.cells.materials = mesh.materials;
  const double own = bulk_calibration(p, materials[0]).spring_shear_modulus;
  std::vector<double> stiffness;  // of a cell's springs over those of the body's own material
  for (const IsotropicMaterial& m : materials) {
    const BulkCalibration calibration = bulk_calibration(p, m);
    network.cells.relative_densities.push_back(m.density / materials[0].density);
    if (!stiffness.empty()) add_region(laws_of(p, network, m, calibration, {}), model.laws);
    stiffness.push_back(calibration.spring_shear_modulus / own);
  }
  if (!network.springs.empty()) network.springs = superposed(network, stiffness);
}

/// @throws std::invalid_argument if the mesh has materials that are not given, or the model takes none.
void require_materials(const ModelRow& row, const Mesh& mesh, std::size_t others) {
  if (others == 0 || !has_cut_cells(row)) return require_one_material(mesh);
  for (const int m : mesh.materials)
    if (m > static_cast<int>(others))
      throw std::invalid_argument(fmt::format("a cell is of material {}; {} are given beside the body's", m, others));
}

}  // namespace

double grip_of(const ModelParameters& p, const Mesh& mesh) {
  const double layer = p.row.topology == centres || p.row.topology == hexagonal ? 0.51
                       : p.random.surface_nodes                                 ? 0.0
                                                                                : 1.0;
  const double spacing = p.node_density ? std::cbrt(1 / *p.node_density) : mean_edge(mesh);
  return spacing * p.grip.value_or(layer);
}

void require_material(const ModelParameters& p, const IsotropicMaterial& m) {
  if (!p.springs || !p.springs->material) return;
  const IsotropicMaterial& own = *p.springs->material;
  const auto equal = [](double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b); };
  if (equal(own.youngs_modulus, m.youngs_modulus) && same_poisson_ratio(own.poisson_ratio, m.poisson_ratio) &&
      equal(own.density, m.density))
    return;
  const auto words = [](const IsotropicMaterial& of) {
    return fmt::format("E = {:g} Pa, nu = {:g}, {:g} kg/m^3", of.youngs_modulus, of.poisson_ratio, of.density);
  };
  throw InputError(
      fmt::format("{}: /material: the springs are those of {} (allowed: the case's, {}; or a file without a "
                  "material)",
                  p.row.name, words(own), words(m)));
}

EmbeddedModel build_embedded(const ModelParameters& p, const Mesh& mesh, const IsotropicMaterial& material,
                             const Region* region, const std::vector<IsotropicMaterial>& others) try {
  require_materials(p.row, mesh, others.size());
  if (p.springs) return build_from_file(p, mesh, material, region);
  if (passes_patch_test(p.row) && !region && !mesh.tetrahedra.empty())
    return build_on_vertices(p, mesh, material, fitted_on_vertices(p, mesh));
  require_cubes(p.row, mesh);
  EmbeddedModel built;
  auto& [network, laws, small_displacements_only] = built.model;
  network = network_of(p, mesh, region);
  const Region* filled = p.row.topology == random ? region : nullptr;
  built.embedding = p.row.topology == cells ? nodes_of_mesh(mesh) : embed(mesh, network, grip_of(p, mesh), filled);
  network.volume *= (filled ? filled->volume : volume(mesh, mesh.nodes)) / network.volume.sum();
  const BulkCalibration calibration = bulk_calibration(p, material);
  NodalVectors gradient;
  if (passes_patch_test(p.row)) {
    gradient = fit_in_body(mesh, region, calibration.spring_shear_modulus, built);
  } else {
    if (p.row.topology == random && p.random.surface_nodes) correct_surface(network);
    if (!network.springs.empty()) calibrate(calibration.spring_shear_modulus, network);
    if (p.has(Extension::momentum_dispersion)) gradient = built.embedding.weights.transpose() * volume_gradient(mesh);
  }
  laws = laws_of(p, network, material, calibration, gradient);
  small_displacements_only = !can(p.row, Capability::large_displacements) || p.shift > 0;
  if (!others.empty() && !mesh.materials.empty()) {
    std::vector<IsotropicMaterial> materials = {material};
    materials.insert(materials.end(), others.begin(), others.end());
    add_materials(p, mesh, materials, built.model);
  }
  return built;
} catch (const std::invalid_argument& e) {
  throw InputError(fmt::format("{}: {}", p.row.name, e.what()));
}

bool has_cut_cells(const ModelRow& row) { return row.topology == cells && can(row, Capability::equal_cells); }

EmbeddedModel build_cut(const ModelParameters& p, const CutBody& body, const std::vector<std::string>& held,
                        const Mesh& mesh, const IsotropicMaterial& material,
                        const std::vector<IsotropicMaterial>& regions) try {
  if (!has_cut_cells(p.row))
    throw InputError(fmt::format(
        "{}: cannot be made of cut cells (allowed: lattices of cells without momentum dispersion)", p.row.name));
  if (p.coarsened.value_or(false))
    throw InputError(
        fmt::format("{}: coarsened: averaged springs alone are built here (allowed: coarsened = false)", p.row.name));
  EmbeddedModel built;
  std::vector<IsotropicMaterial> materials = {material};
  materials.insert(materials.end(), regions.begin(), regions.end());
  built.model.network = cut_lattice(body, held, materials);
  built.model.laws = {averaged_law(p, material, regions), Anchors{}};
  built.model.small_displacements_only = p.shift > 0 || !p.has(Extension::averaging);
  built.embedding = embed(body, held, built.model.network, mesh);
  return built;
} catch (const std::invalid_argument& e) {
  throw InputError(fmt::format("{}: {}", p.row.name, e.what()));
}

}  // namespace springproof
