#include "msm/parameters/model_table.h"

#include <limits>
#include <variant>

#include "msm/exchange/springs_file.h"
#include "msm/parameters/model_options.h"

namespace springproof {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using enum Topology;
using enum Extension;
constexpr Calibration G = Calibration::shear_modulus, E = Calibration::youngs_modulus, patch = Calibration::patch_test;

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
  {"emsm_patch",     "disordered eMSM whose springs pass the patch test at every node",        random,    0,        false, momentum_dispersion, false, false, patch},
  {"emsm_hexagonal", "triangular sheet with momentum dispersion, in plane strain",             hexagonal, 0,        false, momentum_dispersion, false, false, G},
  {"kirkwood",       "triangular sheet with angular springs (Kirkwood), in plane strain",      hexagonal, 0,        false, angular_springs,     false, false, G},
  {"hybmss",         "springs + volume correction; Golec et al. (2019)",                       cells,     2,        true,  volume_correction,   false, false, G},
  {"hybmss_fd",      "HybMSS without face diagonals (A = 0): has zero-energy modes",           cells,     0,        false, volume_correction,   false, false, G},
  {"hybmss_cf",      "HybMSS springs without the volume correction",                           cells,     2,        true,  none,                false, false, G},
  {"hybmss_b",       "HybMSS + bending hourglass correction (linear kinematics)",              cells,     2,        true,  volume_correction,   true,  false, G},
  {"hybmss_bt",      "HybMSS + bending and torsion hourglass correction (linear kinematics)",  cells,     2,        true,  volume_correction,   true,  true,  G},
  {"hybmss_avg",     "recommended: springs averaged over each cell; any strain, any nu",        cells,     16.0 / 9, false, averaging,           true,  true,  G},
};
// clang-format on

constexpr const char *per_node = "a term per node", *per_angle = "a term per angle", *per_cell = "a term per cell";

std::string joined(bool springs, const std::string& terms) {
  return !springs ? terms : terms.empty() ? "springs" : "springs + " + terms;
}

/// What each law adds to springs, by its reach; none of anchors, which are supports.
struct TermOf {
  const char* operator()(const Anchors&) const { return ""; }
  const char* operator()(const AngularSprings&) const { return per_angle; }
  template <class Law>
  const char* operator()(const Law&) const {
    return Law::traits.reach == Reach::springs ? "" : Law::traits.reach == Reach::cells ? per_cell : per_node;
  }
};

/// The laws of a row, without the constants of a material.
std::vector<ForceLaw> laws_in(const ModelRow& row) {
  if (row.extension == averaging) return {AveragedSprings{}};
  std::vector<ForceLaw> laws;
  laws.reserve(3);
  laws.emplace_back(Springs{});
  if (row.extension == volume_correction) laws.emplace_back(VolumeCorrection{});
  if (row.extension == momentum_dispersion) laws.emplace_back(MomentumDispersion{});
  if (row.extension == angular_springs) laws.emplace_back(AngularSprings{});
  if (row.bending_correction) laws.emplace_back(HourglassCorrection{});
  return laws;
}

}  // namespace

const std::vector<ModelRow>& model_table() { return table; }

const ModelRow& recommended_model() {
  const auto& rows = model_table();
  return *std::find_if(rows.begin(), rows.end(),
                       [](const ModelRow& row) { return row.what.starts_with("recommended"); });
}

std::optional<double> own_poisson_ratio(const ModelRow& row) {
  return row.extension == none && row.topology != file ? std::optional(0.25) : std::nullopt;
}

double spring_shear_modulus(const ModelParameters& p, const IsotropicMaterial& material) {
  // With angular springs the planar bulk modulus lambda + G is that of the springs, which is twice their shear modulus.
  if (p.has(angular_springs)) return (lame_lambda(material) + shear_modulus(material)) / 2;
  const bool as_if_quarter = p.paper_e_form || p.row.calibration == Calibration::youngs_modulus;
  return as_if_quarter ? 0.4 * material.youngs_modulus : shear_modulus(material);
}

bool can(const ModelRow& row, Capability what) {
  const std::vector<ForceLaw> laws = laws_in(row);
  return std::all_of(laws.begin(), laws.end(), [&](const ForceLaw& law) { return lacks(law, what).empty(); });
}

std::string made_of(const ModelRow& row) { return made_of(MassSpringModel{{}, laws_in(row)}); }

std::string made_of(const ModelParameters& parameters) {
  if (parameters.cut.value_or(false)) return joined(false, per_cell);
  return parameters.springs ? made_of(parameters.springs->model) : made_of(parameters.row);
}

std::string made_of(const MassSpringModel& model) {
  std::string terms;
  for (const ForceLaw& law : model.laws) {
    const std::string term = std::visit(TermOf{}, law);
    if (terms.find(term) == std::string::npos) terms += (terms.empty() ? "" : " + ") + term;
  }
  return joined(law_of<Springs>(model) != nullptr, terms);
}

}  // namespace springproof
