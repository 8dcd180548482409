#include "msm/models.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meshes/volume.h"
#include "msm/parameters/calibrate.h"
#include "msm/periodic/laws_of_model.h"
#include "msm/topology/cubic_lattice.h"
#include "msm/topology/hexagonal_lattice.h"
#include "msm/topology/node_lattice.h"

namespace springproof {
namespace {

using enum Topology;

/// Edge [m] of a cube of the mesh, or of a cube with the volume of its mean cell.
double mean_edge(const Mesh& mesh) {
  const auto cells = static_cast<double>(mesh.hexahedra.size() + mesh.tetrahedra.size());
  return mesh.grid ? mesh.grid->spacing.maxCoeff() : std::cbrt(volume(mesh, mesh.nodes) / cells);
}

Network network_of(const ModelParameters& p, const Mesh& mesh, const Region* region) {
  switch (p.row.topology) {
    case cells:
      return cubic_lattice(mesh, isotropic_pattern(p.face_to_cube));
    case centres:
      return p.turned == 0 ? node_lattice(mesh, isotropic_pattern(p.face_to_cube))
                           : node_lattice(region ? *region : region_of(mesh), cube_edge(mesh), p.turned,
                                          isotropic_pattern(p.face_to_cube));
    case hexagonal:
      return hexagonal_lattice(mesh, mean_edge(mesh));
    case random:
      break;
  }
  RandomParameters random = p.random;
  random.spacing = p.node_density ? std::cbrt(1 / *p.node_density) : mean_edge(mesh);
  return random_network(region ? *region : region_of(mesh), random);
}

/// Depth [m] to which a support holds nodes: the surface, the outermost layer, or the case's value.
double grip_of(const ModelParameters& p, const Mesh& mesh) {
  const double layer = p.row.topology == centres || p.row.topology == hexagonal ? 0.51
                       : p.random.surface_nodes                                 ? 0.0
                                                                                : 1.0;
  const double spacing = p.node_density ? std::cbrt(1 / *p.node_density) : mean_edge(mesh);
  return spacing * p.grip.value_or(layer);
}

}  // namespace

EmbeddedModel build_embedded(const ModelParameters& p, const Mesh& mesh, const IsotropicMaterial& material,
                             const Region* region) try {
  EmbeddedModel built;
  auto& [network, laws, small_displacements_only] = built.model;
  network = network_of(p, mesh, region);
  const Region* filled = p.row.topology == random ? region : nullptr;
  built.embedding = p.row.topology == cells ? nodes_of_mesh(mesh) : embed(mesh, network, grip_of(p, mesh), filled);
  network.volume *= (filled ? filled->volume : volume(mesh, mesh.nodes)) / network.volume.sum();
  if (p.row.topology == random && p.random.surface_nodes) correct_surface(network);
  const BulkCalibration calibration = bulk_calibration(p, material);
  calibrate(calibration.spring_shear_modulus, network);
  NodalVectors gradient;
  if (p.has(Extension::momentum_dispersion)) gradient = built.embedding.weights.transpose() * volume_gradient(mesh);
  laws = laws_of(p, network, material, calibration, gradient);
  small_displacements_only = !holds_at_large_displacement(p.row);
  return built;
} catch (const std::invalid_argument& e) {
  throw InputError(fmt::format("{}: {}", p.row.name, e.what()));
}

}  // namespace springproof
