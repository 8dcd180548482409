#include "msm/measure/periodic_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msm/calibrate.h"
#include "msm/dispersion_weights.h"
#include "msm/measure/homogenise.h"
#include "msm/topology/cubic_lattice.h"

namespace springproof {
namespace {

Network periodic_network(const ModelParameters& p, double spacing, int nodes) {
  if (p.row.topology == Topology::hexagonal)
    throw InputError(fmt::format("{}: a planar model has no three-dimensional bulk to homogenise", p.row.name));
  if (p.row.topology == Topology::random) {
    RandomParameters random = p.random;
    random.spacing = spacing;
    return periodic_random_network(spacing * std::cbrt(nodes) * Vec3::Ones(), random);
  }
  const int n = std::max(1, static_cast<int>(std::lround(std::cbrt(nodes))));
  const Vec3 box = n * spacing * Vec3::Ones();
  Network network = cubic_lattice(block_mesh(box, {n, n, n}), isotropic_pattern(p.face_to_cube));
  make_periodic(box, network);
  return network;
}

MomentumDispersion dispersion(const ModelParameters& p, const Network& network, const IsotropicMaterial& material) {
  MomentumDispersion law{dispersed_fraction(lame_lambda(material), shear_modulus(material)), p.dispersion, {}};
  if (p.dispersion == Dispersion::symmetric && exact_volumes(p, material)) {
    DispersionWeights exact = volume_weights(network, NodalVectors::Zero(network.nodes(), 3), shear_modulus(material));
    law.weight = std::move(exact.weight);
    law.group = std::move(exact.group);
  }
  return law;
}

}  // namespace

MassSpringModel periodic_model(const ModelParameters& p, const IsotropicMaterial& material, double spacing, int nodes) try {
  MassSpringModel model;
  model.network = periodic_network(p, spacing, nodes);
  calibrate(spring_shear_modulus(p, material), model.network);
  model.laws.push_back(Springs{});
  if (p.has(Extension::volume_correction)) model.laws.push_back(VolumeCorrection{kappa(material), p.volume_energy});
  if (p.has(Extension::momentum_dispersion)) model.laws.push_back(dispersion(p, model.network, material));
  if (p.row.bending_correction)
    model.laws.push_back(HourglassCorrection{shear_modulus(material), material.poisson_ratio, p.face_to_cube, p.row.torsion_correction});
  return model;
} catch (const std::invalid_argument& e) {
  throw InputError(fmt::format("{}: {}", p.row.name, e.what()));
}

}  // namespace springproof
