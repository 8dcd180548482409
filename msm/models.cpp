#include "msm/models.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meshes/volume.h"
#include "msm/laws/dispersion_weights.h"
#include "msm/parameters/calibrate.h"
#include "msm/periodic/bulk_calibration.h"
#include "msm/topology/cubic_lattice.h"
#include "msm/topology/hexagonal_lattice.h"
#include "msm/topology/node_lattice.h"

namespace springproof {
namespace {

using enum Topology;
using enum Extension;

/// Edge of a cube of the mesh, or of one as large as its mean cell [m].
double mean_edge(const Mesh& mesh) {
  const auto cells = static_cast<double>(mesh.hexahedra.size() + mesh.tetrahedra.size());
  return mesh.grid ? mesh.grid->spacing.maxCoeff() : std::cbrt(volume(mesh, mesh.nodes) / cells);
}

Network network_of(const ModelParameters& p, const Mesh& mesh, const Region* region) {
  switch (p.row.topology) {
    case cells:
      return cubic_lattice(mesh, isotropic_pattern(p.face_to_cube));
    case centres:
      return node_lattice(mesh, isotropic_pattern(p.face_to_cube));
    case hexagonal:
      return hexagonal_lattice(mesh, mean_edge(mesh));
    case random:
      break;
  }
  RandomParameters random = p.random;
  random.spacing = p.node_density ? std::cbrt(1 / *p.node_density) : mean_edge(mesh);
  return random_network(region ? *region : region_of(mesh), random);
}

/// Depth [m] to which a support holds nodes: on the surface, the outermost layer, or what the case says.
double grip_of(const ModelParameters& p, const Mesh& mesh) {
  const double layer = p.row.topology == centres || p.row.topology == hexagonal ? 0.51
                       : p.random.surface_nodes                                 ? 0.0
                                                                                : 1.0;
  const double spacing = p.node_density ? std::cbrt(1 / *p.node_density) : mean_edge(mesh);
  return spacing * p.grip.value_or(layer);
}

void calibrate_network(const ModelParameters& p, const IsotropicMaterial& material, double volume_of_body,
                       Network& network) {
  network.volume *= volume_of_body / network.volume.sum();
  if (p.row.topology == random && p.random.surface_nodes) correct_surface(network);
  calibrate(bulk_calibration(p, material).spring_shear_modulus, network);
}

MomentumDispersion dispersion(const ModelParameters& p, const MassSpringModel& model, const Embedding& embedding,
                              const Mesh& mesh, const IsotropicMaterial& material) {
  const BulkCalibration bulk = bulk_calibration(p, material);
  MomentumDispersion law{bulk.q, p.dispersion, {}};
  if (p.dispersion == Dispersion::share_weighted && p.row.topology == cells) law.weight = spring_shares(model.network);
  if (p.dispersion == Dispersion::symmetric && exact_volumes(p, material)) {
    DispersionWeights exact =
        volume_weights(model.network, embedding.weights.transpose() * volume_gradient(mesh), bulk.spring_shear_modulus);
    law.weight = std::move(exact.weight);
    law.group = std::move(exact.group);
  }
  return law;
}

AngularSprings angular(const Network& network, const IsotropicMaterial& material) {
  const double lambda = lame_lambda(material), planar_nu = lambda / (lambda + 2 * shear_modulus(material));
  double k = 0;  // of a spring inside: the boundary has halves
  for (const Spring& s : network.springs) k = std::max(k, s.stiffness);
  return {angular_stiffness(k, network.cell_edge, planar_nu)};
}

}  // namespace

EmbeddedModel build_embedded(const ModelParameters& p, const Mesh& mesh, const IsotropicMaterial& material,
                             const Region* region) try {
  EmbeddedModel built;
  MassSpringModel& model = built.model;
  model.network = network_of(p, mesh, region);
  built.embedding = p.row.topology == cells
                        ? nodes_of_mesh(mesh)
                        : embed(mesh, model.network, grip_of(p, mesh), p.row.topology == random ? region : nullptr);
  calibrate_network(p, material, region && p.row.topology == random ? region->volume : volume(mesh, mesh.nodes),
                    model.network);
  model.laws.push_back(Springs{});
  if (p.has(volume_correction)) model.laws.push_back(VolumeCorrection{kappa(material), p.volume_energy});
  if (p.has(momentum_dispersion)) model.laws.push_back(dispersion(p, model, built.embedding, mesh, material));
  if (p.has(angular_springs)) model.laws.push_back(angular(model.network, material));
  if (p.row.bending_correction) {
    model.laws.push_back(
        HourglassCorrection{shear_modulus(material), material.poisson_ratio, p.face_to_cube, p.row.torsion_correction});
    model.small_displacements_only = !holds_at_large_displacement(p.row);
  }
  return built;
} catch (const std::invalid_argument& e) {
  throw InputError(fmt::format("{}: {}", p.row.name, e.what()));
}

}  // namespace springproof
