#include "msm/measure/validity.h"

#include <limits>

#include "msm/models.h"
#include "msm/statics/equilibrium.h"

namespace springproof {
namespace {

double tension_limit(const ModelParameters& parameters, const IsotropicMaterial& material) {
  const double largest = 0.5;
  const Mesh mesh = block_mesh(Vec3::Ones(), {1, 1, 1});
  const std::optional<double> free;
  const std::vector<Load> loads = {
      PrescribedDisplacement{"x_min", {0.0, free, free}}, PrescribedDisplacement{"y_min", {free, 0.0, free}},
      PrescribedDisplacement{"z_min", {free, free, 0.0}}, PrescribedDisplacement{"z_max", {free, free, largest}}};
  const LoadPath path = [&](double factor) {
    return transfer(loads, mesh, material.density, Kinematics::finite, factor);
  };
  NewtonOptions options;
  options.first_step = 0.02;
  const Equilibrium e = solve_finite(build_model(parameters, mesh, material), path, options);
  return e.ok ? std::numeric_limits<double>::infinity() : largest * e.load_reached;
}

}  // namespace

StrainLimits strain_limits(const ModelParameters& parameters, const IsotropicMaterial& material) {
  ModelParameters p = parameters;
  p.row.bending_correction = p.row.torsion_correction = false;  // for small displacements only; no effect in this state
  StrainLimits limits{};
  p.volume_energy = VolumeEnergy::bounded;
  limits.bounded_energy = tension_limit(p, material);
  p.volume_energy = VolumeEnergy::paper;
  limits.paper_energy = tension_limit(p, material);
  return limits;
}

}  // namespace springproof
