#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "comparisons/advise/advice.h"
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
  return *std::ranges::max_element(materials,
                                   [](const auto& a, const auto& b) { return a.poisson_ratio < b.poisson_ratio; });
}

std::string ratios(const std::vector<IsotropicMaterial>& materials) {
  std::vector<std::string> all;
  for (const IsotropicMaterial& m : materials) all.push_back(fmt::format("{:g}", m.poisson_ratio));
  return fmt::format("nu = {}", fmt::join(all, ", "));
}

std::string geometry_words(const Pilot& pilot, const std::vector<IsotropicMaterial>& materials) {
  const LoadShares& s = pilot.shares;
  return fmt::format(
      "{:.3g} x {:.3g} x {:.3g} m, {}; strain energy: bending {:.0f} %, torsion {:.0f} %, axial {:.0f} %, shear {:.0f} "
      "%, local {:.0f} %",
      pilot.size[0], pilot.size[1], pilot.size[2], ratios(materials), 100 * s.bending, 100 * s.torsion, 100 * s.axial,
      100 * s.shear, 100 * s.local);
}

/// Lattices from the coarsest of the pilot on; of a body of voxels in steps of a quarter of the edge or less.
std::vector<Resolution> resolutions_of(const Pilot& pilot) {
  const bool voxels = pilot.base[0] == 0;
  const double thickness = pilot.size.minCoeff(),
               base = voxels ? 64 : double(pilot.base[0]) * pilot.base[1] * pilot.base[2];
  std::vector<Resolution> out;
  for (int m = 1; m <= 256; ++m) {
    const double cells = std::round(voxels ? base * std::pow(m, 1.5) : base * m * m * m),
                 edge = std::cbrt(pilot.volume / cells);
    if (cells <= most_cells_advised && (!voxels || cells >= pilot.models.front().cells.front()))
      out.push_back({cells, voxels ? 0 : thickness / edge, edge});
  }
  return out;
}

std::vector<std::string> notes_of(const Pilot& pilot) {
  std::vector<std::string> out;
  if (pilot.strain > 0.1 && pilot.experiment_is_linear)
    out.push_back(
        fmt::format("strains reach {:.2g}: small displacements are no longer right (kinematics = \"hencky\" at the top "
                    "of the case)",
                    pilot.strain));
  for (const PilotModel& m : pilot.models)
    if (m.cells.empty()) out.push_back(fmt::format("{} has no result: {}", m.label, m.failure));
  if (pilot.base[0] == 0)
    out.push_back(
        "models without a suffix are in cut cells where they can, 'cut=false' in whole cubes; 'coarsened=true': each "
        "cell is measured once in finer ones, some 7 ms of processor, and kept");
  for (const PilotModel& m : pilot.models)
    for (std::size_t i = 0; i < m.promised.size(); ++i)
      out.push_back(fmt::format("{} = {:.2g} in [body] makes {:.0f} cells, {:.2g} % off", m.label, m.promised[i],
                                m.cells[i], 100 * m.errors[i]));
  return out;
}

/// Of a model or an element; nothing where it has no result.
std::optional<Prediction> prediction_of(const Pilot& pilot, const std::string& label, double cells) {
  const PilotModel* m = pilot.find(label);
  return m && !m->cells.empty() && cells <= m->most_cells ? std::optional(predict(pilot, *m, cells)) : std::nullopt;
}

}  // namespace

Forecast forecast_from(const std::vector<Pilot>& pilots) {
  Forecast out;
  const Pilot& pilot = pilots.back();
  for (const Pilot& p : pilots) out.materials.push_back(p.material);
  out.basis =
      fmt::format("the case itself on coarse lattices; reference: {}, uncertain by {:.2g} % of the displacement",
                  pilot.reference, 100 * pilot.uncertainty);
  out.geometry = geometry_words(pilot, out.materials);
  out.shares = pilot.shares;
  out.material = nearest_to_half(out.materials);
  out.solved_cells = pilot.reference_cells;
  out.solved_seconds = pilot.reference_seconds;
  for (const PilotModel& m : pilot.models) {
    out.models.push_back(m.label);
    if (m.step) out.cut_steps[m.label] = *m.step;
    if (m.making > 0) out.making[m.label] = m.making;
  }
  out.resolutions = resolutions_of(pilot);
  out.predict = [pilots](const std::string& label, const Resolution& r) {
    std::vector<std::optional<Prediction>> all;
    for (const Pilot& p : pilots) all.push_back(prediction_of(p, label, r.cells));
    return worst(all);
  };
  out.notes = notes_of(pilot);
  return out;
}

}  // namespace springproof
