// What to know of a case before its errors are read.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "comparisons/results/records.h"

namespace springproof {
namespace {

bool is_pressure(const Load& load) { return std::holds_alternative<Pressure>(load); }

/// Of a body that its supports carry along.
void add_ride(const CaseResult& result, std::vector<std::string>& out) {
  std::vector<std::string> shares;
  for (const Deformation& d : result.deformations)
    if (d.strained_share < 1)
      shares.push_back(fmt::format("{:.2g} % of it at {} = {:g}", 100 * d.strained_share,
                                   result.experiment.listed.region > 0 ? result.experiment.listed_symbol() : "nu",
                                   d.poisson_ratio));
  if (!shares.empty())
    out.push_back(
        fmt::format("the supports carry the body along: its displacement is a rigid motion but for {}. Displacement "
                    "errors are relative to that part alone",
                    fmt::join(shares, ", ")));
}

/// Of large strain and of motions.
void add_kinematics(const CaseResult& result, std::vector<std::string>& out) {
  const Experiment& e = result.experiment;
  if (std::ranges::any_of(e.loads, is_pressure))
    out.push_back(
        "pressure_Pa is a dead load, per area at rest and against the normals at rest; a pressure that follows the "
        "surface, as that of a gas, gives another result");
  if (e.dynamics && e.dynamics->damping > 0 && std::ranges::none_of(e.loads, prescribes_displacement))
    out.push_back(fmt::format(
        "damping in proportion to the mass (loss_factor, damping_1_s) also brakes what the free body does as "
        "a whole, its fall and its turning, at a rate of {:.3g}/s; viscosity_s alone does not",
        e.dynamics->damping));
  if (e.reference.elements.empty()) return;
  std::map<std::string, std::vector<std::string>> others;
  for (const auto& [label, law] : result.laws)
    if (law != e.kinematics) others[law].push_back(label);
  for (const auto& [law, labels] : others)
    out.push_back(
        fmt::format("{} follow{} the law \"{}\", the reference \"{}\": what these differ by at large strain counts "
                    "among the errors",
                    fmt::join(labels, ", "), labels.size() == 1 ? "s" : "", law, e.kinematics));
}

/// Of models with results whose stresses were asked for and are not known, where the reference's are.
void add_stressless(const CaseResult& result, std::vector<std::string>& out) {
  const auto of_stress = [](const auto& record) { return record.measure.starts_with("stress"); };
  const auto errors = [](const auto& record) { return record.measure.starts_with("stress_error"); };
  if (std::ranges::none_of(result.references, errors)) return;
  std::vector<std::string> labels, all;
  for (const ModelChoice& model : result.experiment.models) all.push_back(model.label);
  for (const std::string& element : result.experiment.elements) all.push_back("fem_" + element);
  for (const std::string& label : all) {
    const auto own = [&](const Row& row) { return row.model == label; };
    if (std::ranges::any_of(result.rows, own) &&
        std::ranges::none_of(result.rows, [&](const Row& r) { return own(r) && of_stress(r); }))
      labels.push_back(label);
  }
  const std::vector<std::string>& measures = result.experiment.measures;
  const auto asked = std::ranges::find_if(measures, [](const auto& m) { return m.starts_with("stress"); });
  if (asked != measures.end() && !labels.empty())
    out.push_back(fmt::format(
        "no {} of {}: stresses are recovered from averaged springs (hybmss_avg, and lattices in cut cells) at rest and "
        "small strain, and from elements that end at the surface of the body (not from cubes of one that has other "
        "faces)",
        *asked, fmt::join(labels, ", ")));
}

}  // namespace

std::vector<std::string> cautions(const CaseResult& result) {
  std::vector<std::string> out;
  add_ride(result, out);
  add_stressless(result, out);
  if (result.experiment.model_kinematics() != Kinematics::linear) add_kinematics(result, out);
  return out;
}

}  // namespace springproof
