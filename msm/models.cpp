#include "msm/models.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "meshes/volume.h"
#include "msm/calibrate.h"
#include "msm/dispersion_weights.h"
#include "msm/measure/bulk_calibration.h"
#include "msm/topology/cubic_lattice.h"
#include "msm/topology/hexagonal_lattice.h"
#include "msm/topology/node_lattice.h"

namespace springproof {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using enum Topology;
using enum Extension;
constexpr Calibration G = Calibration::shear_modulus, E = Calibration::youngs_modulus;

// clang-format off
const std::vector<ModelRow> table = {
//  name              what                                                                     nodes      A         any A  extension          bending torsion calibrated to
  {"msm_18",         "classic 18-spring lattice (edges, face diagonals); nu = 1/4 only",       cells,     infinity, false, none,                false, false, E},
  {"msm_14",         "classic 14-spring lattice (edges, cube diagonals); nu = 1/4 only",       cells,     0,        false, none,                false, false, E},
  {"msm_centred",    "18 springs per node, nodes in the middle of the cubes; nu = 1/4 only",   centres,   infinity, true,  none,                false, false, E},
  {"msm_random",     "disordered network of springs; nu = 1/4 only",                           random,    0,        false, none,                false, false, E},
  {"msm_hexagonal",  "triangular sheet in plane strain; nu = 1/4 (1/3 in the plane) only",     hexagonal, 0,        false, none,                false, false, E},
  {"emsm",           "springs + momentum dispersion; Kot & Nagahashi (2015), as an energy",    cells,     infinity, true,  momentum_dispersion, false, false, G},
  {"emsm_centred",   "eMSM with nodes in the middle of the cubes",                             centres,   infinity, true,  momentum_dispersion, false, false, G},
  {"emsm_random",    "disordered eMSM",                                                        random,    0,        false, momentum_dispersion, false, false, G},
  {"emsm_hexagonal", "triangular sheet with momentum dispersion, in plane strain",             hexagonal, 0,        false, momentum_dispersion, false, false, G},
  {"kirkwood",       "triangular sheet with angular springs (Kirkwood), in plane strain",      hexagonal, 0,        false, angular_springs,     false, false, G},
  {"hybmss",         "springs + volume correction; Golec et al. (2019)",                       cells,     2,        true,  volume_correction,   false, false, G},
  {"hybmss_fd",      "HybMSS without face diagonals (A = 0): has zero-energy modes",           cells,     0,        false, volume_correction,   false, false, G},
  {"hybmss_cf",      "HybMSS springs without the volume correction",                           cells,     2,        true,  none,                false, false, G},
  {"hybmss_b",       "HybMSS + bending hourglass correction (linear kinematics)",              cells,     2,        true,  volume_correction,   true,  false, G},
  {"hybmss_bt",      "HybMSS + bending and torsion hourglass correction (linear kinematics)",  cells,     2,        true,  volume_correction,   true,  true,  G},
};
// clang-format on

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
  const double layer = p.row.topology == centres || p.row.topology == hexagonal ? 0.51 : p.random.surface_nodes ? 0.0 : 1.0;
  const double spacing = p.node_density ? std::cbrt(1 / *p.node_density) : mean_edge(mesh);
  return spacing * p.grip.value_or(layer);
}

void calibrate_network(const ModelParameters& p, const IsotropicMaterial& material, double volume_of_body, Network& network) {
  network.volume *= volume_of_body / network.volume.sum();
  if (p.row.topology == random && p.random.surface_nodes) correct_surface(network);
  calibrate(bulk_calibration(p, material).spring_shear_modulus, network);
}

MomentumDispersion dispersion(const ModelParameters& p, const MassSpringModel& model, const Embedding& embedding, const Mesh& mesh,
                              const IsotropicMaterial& material) {
  const BulkCalibration bulk = bulk_calibration(p, material);
  MomentumDispersion law{bulk.q, p.dispersion, {}};
  if (p.dispersion == Dispersion::share_weighted && p.row.topology == cells) law.weight = spring_shares(model.network);
  if (p.dispersion == Dispersion::symmetric && exact_volumes(p, material)) {
    DispersionWeights exact = volume_weights(model.network, embedding.weights.transpose() * volume_gradient(mesh), bulk.spring_shear_modulus);
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

const std::vector<ModelRow>& model_table() { return table; }

std::optional<double> own_poisson_ratio(const ModelRow& row) {
  return row.extension == none ? std::optional(0.25) : std::nullopt;
}

bool exact_volumes(const ModelParameters& p, const IsotropicMaterial& material) {
  return p.exact_volumes ? *p.exact_volumes : material.poisson_ratio >= springs_poisson_ratio(p);
}

double spring_shear_modulus(const ModelParameters& p, const IsotropicMaterial& material) {
  // Angular springs leave the planar bulk modulus lambda + G to the springs, which have twice their shear modulus for it.
  if (p.has(angular_springs)) return (lame_lambda(material) + shear_modulus(material)) / 2;
  const bool as_if_quarter = p.paper_e_form || p.row.calibration == Calibration::youngs_modulus;
  return as_if_quarter ? 0.4 * material.youngs_modulus : shear_modulus(material);
}

EmbeddedModel build_embedded(const ModelParameters& p, const Mesh& mesh, const IsotropicMaterial& material,
                             const Region* region) try {
  EmbeddedModel built;
  MassSpringModel& model = built.model;
  model.network = network_of(p, mesh, region);
  built.embedding = p.row.topology == cells ? nodes_of_mesh(mesh) : embed(mesh, model.network, grip_of(p, mesh), p.row.topology == random ? region : nullptr);
  calibrate_network(p, material, region && p.row.topology == random ? region->volume : volume(mesh, mesh.nodes), model.network);
  model.laws.push_back(Springs{});
  if (p.has(volume_correction)) model.laws.push_back(VolumeCorrection{kappa(material), p.volume_energy});
  if (p.has(momentum_dispersion)) model.laws.push_back(dispersion(p, model, built.embedding, mesh, material));
  if (p.has(angular_springs)) model.laws.push_back(angular(model.network, material));
  if (p.row.bending_correction) {
    model.laws.push_back(HourglassCorrection{shear_modulus(material), material.poisson_ratio, p.face_to_cube,
                                             p.row.torsion_correction});
    model.small_displacements_only = !holds_at_large_displacement(p.row);
  }
  return built;
} catch (const std::invalid_argument& e) {
  throw InputError(fmt::format("{}: {}", p.row.name, e.what()));
}

}  // namespace springproof
