#include "comparisons/results/records.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "comparisons/results/records_json.h"
#include "problem/case_file/measures.h"
#include "problem/files/file_name.h"

namespace springproof {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(IsotropicMaterial, youngs_modulus, poisson_ratio, density)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Probe, name, at)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Section, point, normal)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Line, from, to, points, middle)

namespace {

using Json = nlohmann::json;

// ---- the parts of a case

Json json_of(const ModelChoice& model) {
  Json options = Json::object();
  for (const auto& [key, value] : model.options)
    options[key] = std::visit([](const auto& x) { return Json(x); }, value);
  return {{"name", model.name}, {"label", model.label}, {"options", options}, {"in_motion", model.in_motion}};
}

Json json_of(const CaseResult& result) {
  const Experiment& e = result.experiment;
  Json loads = Json::array(), models = loads;
  for (const ModelChoice& model : e.models) models.push_back(json_of(model));
  for (std::size_t i = 0; i + e.weights < e.loads.size(); ++i)
    loads.push_back(describe(e.loads[i], e.model_kinematics(), e.units));
  for (const AttachedMass& mass : e.masses) loads.push_back(describe(mass, e.units));
  return {
      {"name", e.name},
      {"folder", e.folder},
      {"cite", e.cite},
      {"what", e.what},
      {"units", names_of_units[static_cast<int>(e.units)]},
      {"kinematics", e.kinematics},
      {"body", {{"geo", e.body.geo}, {"size", result.size}, {"cells", result.cells}, {"voxels", e.body.is_voxels()}}},
      {"materials", e.materials},
      {"poisson_ratios", e.settings()},
      {"listed",
       {{"part", e.listed.region > 0 ? e.regions[e.listed.region - 1].name : ""},
        {"symbol", e.listed_symbol()},
        {"words", e.listed_words()}}},
      {"loads", loads},
      {"models", models},
      {"elements", e.elements},
      {"cost", e.cost},
      {"measures", e.measures},
      {"moved_patches", moved_patches(e)},
      {"probes", e.probes},
      {"section", e.section},
      {"line", e.line},
      {"reference",
       {{"cells", e.reference.cells},
        {"elements", e.reference.elements},
        {"grading", e.reference.grading},
        {"edge", e.reference.edge},
        {"refine", e.reference.refine},
        {"smooth", e.reference.smooth}}},
      {"exact", e.exact},
      {"text", e.text}};
}

}  // namespace

std::string to_string(Verdict verdict) { return Json(verdict); }

bool same_run(const RunKey& a, const RunKey& b) {
  return a.model == b.model && same_poisson_ratio(a.poisson_ratio, b.poisson_ratio) && a.cells == b.cells;
}

std::string file_stem(const RunKey& key) {
  return fmt::format("{}_nu{}_{}", file_name(key.model), key.poisson_ratio, fmt::join(key.cells, "x"));
}

bool is_tetrahedra(const Cells& cells) { return cells[0] > 0 && cells[1] == 0 && cells[2] == 0; }

std::string cells_text(const Cells& cells, std::string_view times) {
  return is_tetrahedra(cells) ? fmt::format("{} tets", cells[0]) : fmt::format("{}", fmt::join(cells, times));
}

double cell_count(const Cells& cells) {
  return is_tetrahedra(cells) ? cells[0] : double(cells[0]) * cells[1] * cells[2];
}

double size_ratio(const Cells& coarse, const Cells& fine, const Cells& finest) {
  const auto refined = is_tetrahedra(finest) ? 3 : std::ranges::count_if(finest, [](int n) { return n > 1; });
  return std::pow(cell_count(fine) / cell_count(coarse), 1.0 / static_cast<double>(std::max(refined, 1L)));
}

Json to_json(const CaseResult& result) {
  Json experiment = json_of(result);
  for (Json& model : experiment["models"]) {
    const auto of = [&](const auto& by_label) {
      const auto found = by_label.find(model["label"]);
      return found == by_label.end() ? Json(nullptr) : Json(found->second);
    };
    model["own_poisson_ratio"] = of(result.own_poisson_ratios);
    model["law"] = of(result.laws);
    model["made_of"] = of(result.made_of);
  }
  Json out = static_cast<const Part&>(result);
  out.erase("pictures");
  for (Json& crack : out["cracks"]) crack.erase("svg");
  out.update({{"experiment", experiment},
              {"checks", result.checks},
              {"published", result.published},
              {"validation", result.validation},
              {"validated", result.validated},
              {"regions", result.regions},
              {"cautions", cautions(result)},
              {"notes", result.notes}});
  return out;
}

}  // namespace springproof
