#include "msm/measure/validity.h"

#include <cmath>
#include <limits>

#include "msm/models.h"
#include "msm/statics/equilibrium.h"

namespace springproof {
namespace {

/// A unit cell with free sides, stretched by `strain` along z.
Equilibrium stretched(const ModelParameters& parameters, const IsotropicMaterial& material, double strain) {
  const Mesh mesh = block_mesh(Vec3::Ones(), {1, 1, 1});
  const std::optional<double> free;
  const std::vector<Load> loads = {
      PrescribedDisplacement{"x_min", {0.0, free, free}}, PrescribedDisplacement{"y_min", {free, 0.0, free}},
      PrescribedDisplacement{"z_min", {free, free, 0.0}}, PrescribedDisplacement{"z_max", {free, free, strain}}};
  const LoadPath path = [&](double factor) {
    return transfer(loads, mesh, material.density, Kinematics::finite, factor);
  };
  NewtonOptions options;
  options.first_step = 0.02;
  return solve_finite(build_model(parameters, mesh, material), path, options);
}

/// hourglass corrections are for small displacements only; no effect in these states
ModelParameters without_corrections(ModelParameters p) {
  if (!p.has(Extension::averaging)) p.row.bending_correction = p.row.torsion_correction = false;
  return p;
}

double tension_limit(const ModelParameters& parameters, const IsotropicMaterial& material) {
  const double largest = 0.5;
  const Equilibrium e = stretched(parameters, material, largest);
  return e.ok ? std::numeric_limits<double>::infinity() : largest * e.load_reached;
}

/// The law as it is, by Newton's method on the lateral stretch.
double neo_hooke_stress(const IsotropicMaterial& m, double stretch) {
  const double G = shear_modulus(m), lambda = lame_lambda(m);
  double t = std::pow(stretch, -m.poisson_ratio);
  for (int i = 0; i < 50; ++i)
    t -= (G * (t * t - 1) + lambda * std::log(stretch * t * t)) / (2 * G * t + 2 * lambda / t);
  return (G * (stretch * stretch - 1) + lambda * std::log(stretch * t * t)) / stretch;
}

}  // namespace

StrainLimits strain_limits(const ModelParameters& parameters, const IsotropicMaterial& material) {
  ModelParameters p = without_corrections(parameters);
  StrainLimits limits{};
  p.volume_energy = VolumeEnergy::bounded;
  limits.bounded_energy = tension_limit(p, material);
  p.volume_energy = VolumeEnergy::paper;
  limits.paper_energy = tension_limit(p, material);
  return limits;
}

std::vector<StressAtStretch> stress_curve(const ModelParameters& parameters, const IsotropicMaterial& m) {
  const ModelParameters p = without_corrections(parameters);
  std::vector<StressAtStretch> curve;
  for (const double stretch : {0.6, 0.7, 0.8, 0.9, 0.95, 1.05, 1.1, 1.2, 1.3, 1.4}) {
    StressAtStretch at{stretch, {}, m.youngs_modulus * std::log(stretch) / stretch, neo_hooke_stress(m, stretch)};
    const Equilibrium e = stretched(p, m, stretch - 1);
    if (e.ok) at.model = e.support.col(2).tail<4>().sum();
    curve.push_back(at);
  }
  return curve;
}

}  // namespace springproof
