#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "comparisons/advise/advice.h"
#include "comparisons/advise/check.h"
#include "msm/parameters/model_table.h"

namespace springproof {
namespace {

constexpr double most_cells_advised = 1e7;  // of a lattice that is advised

/// The worst prediction; nothing if one is missing.
std::optional<Prediction> worst(const std::vector<std::optional<Prediction>>& all) {
  std::optional<Prediction> out;
  for (const auto& p : all) {
    if (!p) return {};
    if (!out || p->error > out->error) out = Prediction{p->error, p->factor, p->beyond || (out && out->beyond)};
    out->factor = std::max(out->factor, p->factor);
  }
  return out;
}

const IsotropicMaterial& nearest_to_half(const std::vector<IsotropicMaterial>& materials) {
  return *std::max_element(materials.begin(), materials.end(),
                           [](const auto& a, const auto& b) { return a.poisson_ratio < b.poisson_ratio; });
}

std::string ratios(const std::vector<IsotropicMaterial>& materials) {
  std::vector<std::string> all;
  for (const IsotropicMaterial& m : materials) all.push_back(fmt::format("{:g}", m.poisson_ratio));
  return fmt::format("nu = {}", fmt::join(all, ", "));
}

}  // namespace

Forecast forecast_from(const std::vector<Measurement>& measured, const Loading& loading, double thickness,
                       const std::vector<IsotropicMaterial>& materials, const std::vector<std::string>& models) {
  Forecast out;
  out.basis = "measured errors of clamped blocks and round bars (measured.csv)";
  out.geometry =
      fmt::format("{} {:g} times as long as thick, {}{}, {}", loading.body, loading.slenderness, loading.load,
                  loading.strain > 0 ? fmt::format(" at a strain of {:g}", loading.strain) : "", ratios(materials));
  out.load = loading.load;
  out.small_strain = loading.strain == 0;
  out.material = nearest_to_half(materials);
  out.models = models;
  const double s = loading.slenderness, share = loading.body == "round" ? M_PI / 4 : 1;
  for (const int n : {1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 96, 128}) {
    const double across = s < 1 ? n / s : n, cells = share * across * across * (s < 1 ? n : n * s);
    if (cells <= most_cells_advised) out.resolutions.push_back({cells, double(n), thickness * std::min(1.0, s) / n});
  }
  const auto at = [measured, loading, materials](const std::string& model, const Resolution& r) {
    std::vector<std::optional<Prediction>> all;
    for (const IsotropicMaterial& m : materials)
      all.push_back(predict(measured, loading, model, m.poisson_ratio, r.across));
    return worst(all);
  };
  out.predict = at;
  out.predict_element = at;
  if (loading.body == "round")
    out.notes.push_back(
        "models without a suffix are in cut cells (but for hybmss_avg at rest only), 'cut=false' in whole cubes");
  return out;
}

Forecast forecast_from(const std::vector<Measurement>& measured, const std::vector<Pilot>& pilots) {
  Forecast out;
  const Pilot& pilot = pilots.back();
  std::vector<IsotropicMaterial> materials;
  for (const Pilot& p : pilots) materials.push_back(p.material);
  out.basis =
      fmt::format("the case itself on coarse lattices; reference: {}, uncertain by {:.2g} % of the displacement",
                  pilot.reference, 100 * pilot.uncertainty);
  const Classified kind = classify(pilot);
  const bool voxels = pilot.base[0] == 0;
  const LoadShares& s = pilot.shares;
  out.geometry = fmt::format(
      "{:.3g} x {:.3g} x {:.3g} m, {}; strain energy: bending {:.0f} %, torsion {:.0f} %, axial {:.0f} %, shear {:.0f} "
      "%, "
      "local {:.0f} %",
      pilot.size[0], pilot.size[1], pilot.size[2], ratios(materials), 100 * s.bending, 100 * s.torsion, 100 * s.axial,
      100 * s.shear, 100 * s.local);
  out.load = kind.load;
  out.shares = s;
  out.small_strain = pilot.experiment_is_linear;
  out.material = nearest_to_half(materials);
  out.solved_cells = pilot.reference_cells;
  out.solved_seconds = pilot.reference_seconds;
  for (const PilotModel& m : pilot.models) out.models.push_back(m.label);
  const double thickness = pilot.size.minCoeff();
  for (int m = 1; m <= 256; ++m) {
    const double base = voxels ? 64 : double(pilot.base[0]) * pilot.base[1] * pilot.base[2];
    const double cells = voxels ? base * std::pow(m, 1.5) : base * m * m * m, edge = std::cbrt(pilot.volume / cells);
    if (cells <= most_cells_advised && (!voxels || cells >= pilot.models.front().cells.front()))
      out.resolutions.push_back({cells, voxels ? 0 : thickness / edge, edge});
  }
  out.predict = [pilots](const std::string& model, const Resolution& r) {
    std::vector<std::optional<Prediction>> all;
    for (const Pilot& p : pilots)
      for (const PilotModel& m : p.models)
        if (m.label == model) all.push_back(m.cells.empty() ? std::nullopt : std::optional(predict(p, m, r.cells)));
    return worst(all);
  };
  out.predict_element = [measured, kind, materials, voxels](const std::string& element,
                                                            const Resolution& r) -> std::optional<Prediction> {
    if (voxels) return {};
    std::vector<std::optional<Prediction>> all;
    for (const IsotropicMaterial& m : materials)
      all.push_back(predict(measured, {kind.load, "block", kind.slenderness, 0}, element, m.poisson_ratio, r.across));
    return worst(all);
  };
  if (pilot.strain > 0.1 && out.small_strain)
    out.notes.push_back(
        fmt::format("strains reach {:.2g}: small displacements are no longer right (kinematics = "
                    "\"hencky\" in the case)",
                    pilot.strain));
  for (const PilotModel& m : pilot.models)
    if (m.cells.empty()) out.notes.push_back(fmt::format("{} has no result: {}", m.label, m.failure));
  if (voxels)
    out.notes.push_back(
        "models without a suffix are in cut cells where they can, 'cut=false' in whole cubes; times of a step are "
        "known "
        "of whole cubes only");
  return out;
}

}  // namespace springproof
