#include "msm/periodic/periodic_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msm/parameters/calibrate.h"
#include "msm/parameters/patch_fit.h"
#include "msm/periodic/homogenise.h"
#include "msm/periodic/laws_of_model.h"
#include "msm/topology/cubic_lattice.h"

namespace springproof {
namespace {

Network periodic_lattice(const ModelParameters& p, double spacing, int nodes) {
  const int n = std::max(1, static_cast<int>(std::lround(std::cbrt(nodes))));
  const Vec3 box = n * spacing * Vec3::Ones();
  Network network = cubic_lattice(block_mesh(box, {n, n, n}), isotropic_pattern(p.face_to_cube));
  make_periodic(box, network);
  return network;
}

}  // namespace

MassSpringModel periodic_random_model(const ModelParameters& p, const BulkCalibration& c, double spacing, int nodes) {
  RandomParameters random = p.random;
  random.spacing = spacing;
  random.windows = false;  // they compensate for walls, which a periodic cell does not have
  MassSpringModel model{periodic_random_network(spacing * std::cbrt(nodes) * Vec3::Ones(), random), {Springs{}}};
  const NodalVectors no_surface = NodalVectors::Zero(model.network.nodes(), 3);
  if (passes_patch_test(p.row))
    fit_patch(no_surface, c.spring_shear_modulus, model.network);
  else if (random.surface_nodes)
    correct_surface(model.network);
  calibrate(c.spring_shear_modulus, model.network);
  if (p.has(Extension::momentum_dispersion)) model.laws.push_back(dispersion_law(p, model.network, c, no_surface));
  return model;
}

MassSpringModel periodic_model(const ModelParameters& parameters, const IsotropicMaterial& material, double spacing,
                               int nodes) try {
  ModelParameters p = parameters;
  if (p.row.topology == Topology::hexagonal)
    throw InputError(fmt::format("{}: a planar model has no three-dimensional bulk to homogenise", p.row.name));
  const BulkCalibration bulk = bulk_calibration(parameters, material);
  if (p.has(Extension::momentum_dispersion) && has_energy(p.dispersion)) p.exact_volumes = exact_volumes(p, material);
  if (p.row.topology == Topology::random) return periodic_random_model(p, bulk, spacing, nodes);
  MassSpringModel model{periodic_lattice(p, spacing, nodes), {}};
  calibrate(bulk.spring_shear_modulus, model.network);
  model.laws = laws_of(p, model.network, material, bulk, NodalVectors::Zero(model.network.nodes(), 3));
  return model;
} catch (const std::invalid_argument& e) {
  throw InputError(fmt::format("{}: {}", parameters.row.name, e.what()));
}

}  // namespace springproof
