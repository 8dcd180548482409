#include "msm/models.h"

#include <fmt/format.h>

#include <limits>

#include "msm/calibrate.h"
#include "msm/dispersion_weights.h"
#include "msm/topology/cubic_lattice.h"

namespace springproof {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using enum Topology;
using enum Extension;
constexpr Calibration G = Calibration::shear_modulus, E = Calibration::youngs_modulus;

// clang-format off
const std::vector<ModelRow> table = {
//  name         what                                                                         nodes  A         any A  extension          bending torsion calibrated to
  {"msm_18",    "classic 18-spring lattice (edges, face diagonals); nu = 1/4 only",           cells, infinity, false, none,                false, false, E},
  {"msm_14",    "classic 14-spring lattice (edges, cube diagonals); nu = 1/4 only",           cells, 0,        false, none,                false, false, E},
  {"emsm",      "springs + momentum dispersion; Kot & Nagahashi (2015), as an energy",        cells, infinity, true,  momentum_dispersion, false, false, G},
  {"hybmss",    "springs + volume correction; Golec et al. (2019)",                           cells, 2,        true,  volume_correction,   false, false, G},
  {"hybmss_fd", "HybMSS without face diagonals (A = 0): has zero-energy modes",               cells, 0,        false, volume_correction,   false, false, G},
  {"hybmss_cf", "HybMSS springs without the volume correction",                               cells, 2,        true,  none,                false, false, G},
  {"hybmss_b",  "HybMSS + bending hourglass correction (linear kinematics)",                  cells, 2,        true,  volume_correction,   true,  false, G},
  {"hybmss_bt", "HybMSS + bending and torsion hourglass correction (linear kinematics)",      cells, 2,        true,  volume_correction,   true,  true,  G},
};
// clang-format on

MomentumDispersion dispersion(const ModelParameters& p, const Network& network, const IsotropicMaterial& material) {
  MomentumDispersion law{dispersed_fraction(lame_lambda(material), shear_modulus(material)), p.dispersion, {}};
  if (p.dispersion == Dispersion::share_weighted) law.weight = spring_shares(network);
  if (p.dispersion == Dispersion::symmetric && p.volume_weights)
    law.weight = volume_weights(network, cell_volume_gradient(network), shear_modulus(material)).weight;
  return law;
}

}  // namespace

const std::vector<ModelRow>& model_table() { return table; }

double spring_shear_modulus(const ModelParameters& p, const IsotropicMaterial& material) {
  const bool as_if_quarter = p.paper_e_form || p.row.calibration == Calibration::youngs_modulus;
  return as_if_quarter ? 0.4 * material.youngs_modulus : shear_modulus(material);
}

MassSpringModel build_model(const ModelParameters& p, const Mesh& mesh, const IsotropicMaterial& material) {
  MassSpringModel model;
  try {
    model.network = cubic_lattice(mesh, isotropic_pattern(p.face_to_cube));
  } catch (const std::invalid_argument& e) {
    throw InputError(fmt::format("{}: {}", p.row.name, e.what()));
  }
  calibrate(spring_shear_modulus(p, material), model.network);
  model.laws.push_back(Springs{});
  if (p.has(volume_correction)) model.laws.push_back(VolumeCorrection{kappa(material), p.volume_energy});
  if (p.has(momentum_dispersion)) model.laws.push_back(dispersion(p, model.network, material));
  if (p.row.bending_correction) {
    model.laws.push_back(HourglassCorrection{shear_modulus(material), material.poisson_ratio, p.face_to_cube,
                                             p.row.torsion_correction});
    model.small_displacements_only = true;
  }
  return model;
}

}  // namespace springproof
