#include "msm/periodic/laws_of_model.h"

#include <algorithm>

#include "msm/laws/nodal_gradients.h"

namespace springproof {
namespace {

AngularSprings angular(const Network& network, const IsotropicMaterial& material) {
  const double lambda = lame_lambda(material), planar_nu = lambda / (lambda + 2 * shear_modulus(material));
  double k = 0;  // of an interior spring: those of the boundary have half
  for (const Spring& s : network.springs) k = std::max(k, s.stiffness);
  return {angular_stiffness(k, network.cells.edge, planar_nu)};
}

}  // namespace

MomentumDispersion dispersion_law(const ModelParameters& p, const Network& network, const BulkCalibration& calibration,
                                  const NodalVectors& volume_gradient, WeightStart start) {
  MomentumDispersion law{calibration.q, p.dispersion};
  law.curve = p.curve.value_or(StrainCurve::hencky);
  if (p.dispersion == Dispersion::share_weighted && p.row.topology == Topology::cells)
    law.weight = spring_shares(network);
  if (has_energy(p.dispersion) && p.exact_volumes.value_or(false)) {
    DispersionWeights exact = volume_weights(network, volume_gradient, calibration.spring_shear_modulus, start);
    law.weight = std::move(exact.weight);
    law.group = std::move(exact.group);
  }
  if (law.form == Dispersion::finite_strain) const NodalGradients every_node(law, network);  // refuses what it must
  return law;
}

AveragedSprings averaged_law(const ModelParameters& p, const IsotropicMaterial& material,
                             const std::vector<IsotropicMaterial>& regions) {
  AveragedSprings law;
  law.shear_modulus = spring_shear_modulus(p, material);
  const bool has_volume_term = p.has(Extension::volume_correction) || p.has(Extension::averaging);
  law.lame_lambda = law.shear_modulus + (has_volume_term ? kappa(material) : 0);
  law.hourglass = HourglassStiffness::of_pattern(p.face_to_cube, material.poisson_ratio, p.row.bending_correction,
                                                 p.row.torsion_correction, p.slender);
  law.shift = p.shift;
  law.contraction = material.poisson_ratio / (1 - material.poisson_ratio);
  law.curve = p.curve.value_or(StrainCurve::hencky);
  for (const IsotropicMaterial& m : regions) law.regions.push_back(averaged_law(p, m));
  return law;
}

AveragedSprings measuring_law(const ModelParameters& p, const IsotropicMaterial& material,
                              const std::vector<IsotropicMaterial>& regions) {
  const auto ratio = [](const IsotropicMaterial& m) { return std::min(m.poisson_ratio, 0.3); };
  const IsotropicMaterial own = {1, ratio(material), 1};
  std::vector<IsotropicMaterial> others;
  for (const IsotropicMaterial& m : regions) {
    const double G = shear_modulus(own) * shear_modulus(m) / shear_modulus(material);
    others.push_back({2 * G * (1 + ratio(m)), ratio(m), 1});
  }
  return averaged_law(p, own, others);
}

std::vector<ForceLaw> laws_of(const ModelParameters& parameters, const Network& network,
                              const IsotropicMaterial& material, const BulkCalibration& calibration,
                              const NodalVectors& volume_gradient, WeightStart start) {
  using enum Extension;
  ModelParameters p = parameters;
  if (p.has(averaging)) return {averaged_law(p, material)};
  std::vector<ForceLaw> laws = {Springs{}};
  if (p.has(volume_correction)) laws.push_back(VolumeCorrection{kappa(material), p.volume_energy});
  if (p.has(momentum_dispersion)) {
    if (has_energy(p.dispersion)) p.exact_volumes = exact_volumes(p, material);
    laws.push_back(dispersion_law(p, network, calibration, volume_gradient, start));
  }
  if (p.has(angular_springs)) laws.push_back(angular(network, material));
  if (p.row.bending_correction)
    laws.push_back(
        HourglassCorrection{shear_modulus(material), material.poisson_ratio, p.face_to_cube, p.row.torsion_correction});
  return laws;
}

}  // namespace springproof
