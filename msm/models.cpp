#include "msm/models.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "msm/calibrate.h"
#include "msm/topology/cubic_lattice.h"
#include "problem/nearest_name.h"

namespace springproof {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// clang-format off
const std::vector<ModelRow> table = {
//  name          what                                                                     A         any A  volume bending torsion calibrated to
  {"msm_18",    "classic 18-spring lattice (edges, face diagonals); nu = 1/4 only",      infinity, false, false, false, false, Calibration::youngs_modulus},
  {"msm_14",    "classic 14-spring lattice (edges, cube diagonals); nu = 1/4 only",      0,        false, false, false, false, Calibration::youngs_modulus},
  {"hybmss",    "springs + volume correction; Golec et al. (2019)",                      2,        true,  true,  false, false, Calibration::shear_modulus},
  {"hybmss_fd", "HybMSS without face diagonals (A = 0): has zero-energy modes",          0,        false, true,  false, false, Calibration::shear_modulus},
  {"hybmss_cf", "HybMSS springs without the volume correction",                          2,        true,  false, false, false, Calibration::shear_modulus},
  {"hybmss_b",  "HybMSS + bending hourglass correction (linear kinematics)",             2,        true,  true,  true,  false, Calibration::shear_modulus},
  {"hybmss_bt", "HybMSS + bending and torsion hourglass correction (linear kinematics)", 2,        true,  true,  true,  true,  Calibration::shear_modulus},
};
// clang-format on

[[noreturn]] void refuse_option(const ModelChoice& choice, const std::string& message) {
  throw InputError(choice.where, fmt::format("models: {}: {}", choice.name, message));
}

}  // namespace

const std::vector<ModelRow>& model_table() { return table; }

ModelParameters resolve(const ModelChoice& choice) {
  const auto row = std::find_if(table.begin(), table.end(), [&](const ModelRow& r) { return r.name == choice.name; });
  if (row == table.end()) {
    std::vector<std::string> names;
    for (const ModelRow& r : table) names.push_back(r.name);
    throw InputError(choice.where, fmt::format("models: unknown model '{}' (allowed: {}){}", choice.name,
                                               fmt::join(names, ", "), did_you_mean(choice.name, names)));
  }
  ModelParameters p{*row, row->face_to_cube, false, VolumeEnergy::bounded};
  for (const auto& [key, value] : choice.options) {
    if (key == "face_to_cube") {
      const double* A = std::get_if<double>(&value);
      if (!A || !(*A >= 0)) refuse_option(choice, "face_to_cube must be a number >= 0");
      if (!row->any_face_to_cube && *A != row->face_to_cube)
        refuse_option(choice, fmt::format("face_to_cube is {} by definition of this model", row->face_to_cube));
      p.face_to_cube = *A;
    } else if (key == "paper_e_form") {
      const bool* on = std::get_if<bool>(&value);
      if (!on) refuse_option(choice, "paper_e_form must be true or false");
      p.paper_e_form = *on;
    } else if (key == "volume_energy") {
      const std::string* form = std::get_if<std::string>(&value);
      if (!form || (*form != "paper" && *form != "bounded"))
        refuse_option(choice, "volume_energy must be \"paper\" or \"bounded\"");
      p.volume_energy = *form == "paper" ? VolumeEnergy::paper : VolumeEnergy::bounded;
    } else {
      const std::vector<std::string> known = {"face_to_cube", "paper_e_form", "volume_energy"};
      refuse_option(choice, fmt::format("unknown option '{}' (allowed: {}){}", key, fmt::join(known, ", "),
                                        did_you_mean(key, known)));
    }
  }
  return p;
}

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
  if (p.row.volume_correction) model.laws.push_back(VolumeCorrection{kappa(material), p.volume_energy});
  if (p.row.bending_correction) {
    model.laws.push_back(HourglassCorrection{shear_modulus(material), material.poisson_ratio, p.face_to_cube,
                                             p.row.torsion_correction});
    model.small_displacements_only = true;
  }
  return model;
}

}  // namespace springproof
