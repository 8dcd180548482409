#include "comparisons/report/results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "problem/case_file/measures.h"
#include "problem/system/encoding.h"

namespace springproof {
namespace {

using Json = nlohmann::json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
Json number(const std::optional<double>& x) { return x ? number(*x) : Json(nullptr); }

Json numbers(const std::vector<double>& xs) {
  Json out = Json::array();
  for (double x : xs) out.push_back(number(x));
  return out;
}

Json vector(const Vec3& v) { return numbers({v.x(), v.y(), v.z()}); }

// ---- the parts of a case

Json json_of(const IsotropicMaterial& m) {
  return {{"youngs_modulus", number(m.youngs_modulus)},
          {"poisson_ratio", number(m.poisson_ratio)},
          {"density", number(m.density)}};
}

Json json_of(const ModelChoice& model) {
  Json options = Json::object();
  for (const auto& [key, value] : model.options)
    options[key] = std::visit([](const auto& x) { return Json(x); }, value);
  return {{"name", model.name}, {"label", model.label}, {"options", options}, {"in_motion", model.in_motion}};
}

Json json_of(const Probe& probe) { return {{"name", probe.name}, {"at", vector(probe.at)}}; }

Json json_of(const Section& section) { return {{"point", vector(section.point)}, {"normal", vector(section.normal)}}; }

Json json_of(const Line& line) {
  return {{"from", vector(line.from)}, {"to", vector(line.to)}, {"points", line.points}, {"middle", line.middle}};
}

Json json_of(const Row& r) {
  return {{"case_name", r.case_name},
          {"kinematics", r.kinematics},
          {"model", r.model},
          {"poisson_ratio", number(r.poisson_ratio)},
          {"cells", r.cells},
          {"measure", r.measure},
          {"value", number(r.value)},
          {"unit", r.unit},
          {"reference", number(r.reference)},
          {"reference_uncertainty", number(r.reference_uncertainty)},
          {"error", number(r.error)},
          {"samples", r.samples},
          {"spread", number(r.spread)}};
}

Json json_of(const Stability& s) {
  return {{"load_reached", number(s.load_reached)},
          {"lost", s.lost},
          {"strain", number(s.strain)},
          {"softest", number(s.softest)},
          {"alternation", numbers(s.alternation)},
          {"wrinkles", number(s.wrinkles)}};
}

Json json_of(const LatticeLimit& l) {
  return {{"model", l.model},
          {"poisson_ratio", number(l.poisson_ratio)},
          {"imposed", number(l.imposed)},
          {"free", number(l.free)},
          {"held", number(l.held)},
          {"wave", l.wave},
          {"instead", l.instead}};
}

Json json_of(const Run& r) {
  return {{"model", r.model},
          {"kind", r.kind},
          {"poisson_ratio", number(r.poisson_ratio)},
          {"cells", r.cells},
          {"kinematics", r.kinematics},
          {"ok", r.ok},
          {"message", r.message},
          {"solver", r.solver},
          {"iterations", r.iterations},
          {"residual", number(r.residual)},
          {"set_up_seconds", number(r.set_up_seconds)},
          {"seconds", number(r.seconds)},
          {"unknowns", r.unknowns},
          {"memory_MiB", number(r.memory_MiB)},
          {"stability", r.stability ? json_of(*r.stability) : Json(nullptr)}};
}

Json json_of(const ReferenceRecord& r) {
  return {{"poisson_ratio", number(r.poisson_ratio)},
          {"measure", r.measure},
          {"unit", r.unit},
          {"cells", r.cells},
          {"values", numbers(r.values)},
          {"observed_order", number(r.observed_order)},
          {"value", number(r.value)},
          {"uncertainty", number(r.uncertainty)},
          {"note", r.note},
          {"element", r.element},
          {"converging", r.converging},
          {"correlation", number(r.correlation)}};
}

Json json_of(const Check& c) {
  return {{"model", c.model},
          {"poisson_ratio", number(c.poisson_ratio)},
          {"cells", c.cells},
          {"measure", c.measure},
          {"unit", c.unit},
          {"source", c.source},
          {"expected", number(c.expected)},
          {"computed", number(c.computed)},
          {"within", number(c.within)},
          {"reference_uncertainty", number(c.reference_uncertainty)},
          {"verdict", to_string(c.verdict)},
          {"where", c.where},
          {"at_least", c.at_least}};
}

Json json_of(const LineRecord& l) {
  return {{"model", l.model},
          {"poisson_ratio", number(l.poisson_ratio)},
          {"cells", l.cells},
          {"first", l.first},
          {"last", l.last},
          {"distance", numbers(l.distance)},
          {"strain", numbers(l.strain)},
          {"stress", numbers(l.stress)},
          {"exact_strain", numbers(l.exact_strain)},
          {"exact_stress", numbers(l.exact_stress)}};
}

Json json_of(const HistoryRecord& h) {
  Json values = Json::array();
  for (const std::vector<double>& of_one : h.values) values.push_back(numbers(of_one));
  return {{"model", h.model},
          {"poisson_ratio", number(h.poisson_ratio)},
          {"cells", h.cells},
          {"time_step", number(h.time_step)},
          {"time", numbers(h.time)},
          {"names", h.names},
          {"units", h.units},
          {"values", values},
          {"integrator", h.integrator},
          {"measured", h.measured},
          {"probe", h.probe}};
}

Json json_of(const ErrorSplit& s) {
  return {{"model", s.model},
          {"poisson_ratio", number(s.poisson_ratio)},
          {"cells", s.cells},
          {"voxel_edge_m", number(s.voxel_edge)},
          {"measure", s.measure},
          {"unit", s.unit},
          {"total", number(s.total)},
          {"model_error", number(s.model_error)},
          {"discretisation_error", number(s.discretisation_error)},
          {"geometry_error", number(s.geometry_error)},
          {"uncertainty", number(s.body_uncertainty)},
          {"voxel_uncertainty", number(s.voxel_uncertainty)}};
}

Json json_of(const Deformation& d) {
  return {{"poisson_ratio", number(d.poisson_ratio)},
          {"principal_strain", number(d.principal_strain)},
          {"rotation_deg", number(d.rotation_deg)}};
}

Json json_of(const CrackRecord& c) {
  return {{"model", c.model},
          {"poisson_ratio", number(c.poisson_ratio)},
          {"cells", c.cells},
          {"shrinkage", numbers(c.shrinkage)},
          {"broken", numbers(c.broken)},
          {"fragments", numbers(c.fragments)},
          {"stored", numbers(c.stored)},
          {"released", numbers(c.released)},
          {"directions", numbers(c.directions)}};
}

Json json_of(const PublishedRow& p) {
  return {{"model", p.model},
          {"poisson_ratio", number(p.poisson_ratio)},
          {"cells", p.cells},
          {"measure", p.measure},
          {"unit", p.unit},
          {"published", number(p.published)},
          {"computed", number(p.computed)},
          {"where", p.where},
          {"remark", p.remark}};
}

template <class T>
Json list(const std::vector<T>& items) {
  Json out = Json::array();
  for (const T& item : items) out.push_back(json_of(item));
  return out;
}

Json json_of(const CaseResult& result) {
  const Experiment& e = result.experiment;
  Json poisson_ratios = Json::array(), loads = Json::array();
  for (const auto& m : e.materials) poisson_ratios.push_back(number(m.poisson_ratio));
  for (const auto& load : e.loads) loads.push_back(describe(load, e.model_kinematics()));
  return {
      {"name", e.name},
      {"folder", e.folder},
      {"cite", e.cite},
      {"what", e.what},
      {"kinematics", e.kinematics},
      {"body",
       {{"geo", e.body.geo}, {"size", vector(result.size)}, {"cells", result.cells}, {"voxels", e.body.is_voxels()}}},
      {"materials", list(e.materials)},
      {"poisson_ratios", poisson_ratios},
      {"loads", loads},
      {"models", list(e.models)},
      {"elements", e.elements},
      {"cost", e.cost},
      {"measures", e.measures},
      {"moved_patches", moved_patches(e)},
      {"probes", list(e.probes)},
      {"section", e.section ? json_of(*e.section) : Json(nullptr)},
      {"line", e.line ? json_of(*e.line) : Json(nullptr)},
      {"reference",
       {{"cells", e.reference.cells},
        {"elements", e.reference.elements},
        {"grading", e.reference.grading},
        {"edge", e.reference.edge},
        {"smooth", e.reference.smooth}}},
      {"exact", e.exact},
      {"text", e.text}};
}

}  // namespace

std::string to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::reference_too_coarse:
      return "reference too coarse";
    case Verdict::no_reference:
      return "no reference";
    case Verdict::no_result:
      return "no result";
  }
  throw std::invalid_argument("no such verdict");
}

bool same_run(const RunKey& a, const RunKey& b) {
  return a.model == b.model && same_poisson_ratio(a.poisson_ratio, b.poisson_ratio) && a.cells == b.cells;
}

bool is_tetrahedra(const Cells& cells) { return cells[0] > 0 && cells[1] == 0 && cells[2] == 0; }

std::string cells_text(const Cells& cells, std::string_view times) {
  return is_tetrahedra(cells) ? fmt::format("{} tets", cells[0]) : fmt::format("{}", fmt::join(cells, times));
}

double cell_count(const Cells& cells) {
  return is_tetrahedra(cells) ? cells[0] : double(cells[0]) * cells[1] * cells[2];
}

Json to_json(const CaseResult& result) {
  Json experiment = json_of(result);
  for (Json& model : experiment["models"]) {
    const auto own = result.own_poisson_ratios.find(model["label"]);
    model["own_poisson_ratio"] = own == result.own_poisson_ratios.end() ? Json(nullptr) : number(own->second);
    const auto law = result.laws.find(model["label"]);
    model["law"] = law == result.laws.end() ? Json(nullptr) : Json(law->second);
  }
  return {{"experiment", experiment},      {"runs", list(result.runs)},
          {"rows", list(result.rows)},     {"references", list(result.references)},
          {"checks", list(result.checks)}, {"published", list(result.published)},
          {"lines", list(result.lines)},   {"histories", list(result.histories)},
          {"splits", list(result.splits)}, {"deformations", list(result.deformations)},
          {"cracks", list(result.cracks)}, {"limits", list(result.limits)},
          {"cautions", cautions(result)},  {"notes", result.notes}};
}

std::string csv_text(const std::string& field) {
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string out = "\"";
  for (char c : field) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string csv_number(const std::optional<double>& x) { return x && std::isfinite(*x) ? fmt::format("{}", *x) : ""; }

namespace {

/// A printed value of a case, whichever table of the case file it is from.
std::vector<PublishedRow> printed_values(const CaseResult& result) {
  std::vector<PublishedRow> all;
  for (const Check& c : result.checks)
    if (c.source == "published") all.push_back({c, c.measure, c.unit, c.expected, c.computed, c.where, ""});
  all.insert(all.end(), result.published.begin(), result.published.end());
  return all;
}

bool printed_for(const PublishedRow& printed, const Row& row) {
  return same_run(printed, row) && printed.measure == row.measure;
}

std::string csv_line(const Row& r, const PublishedRow* printed) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_text(r.case_name), csv_text(r.kinematics),
                     csv_text(r.model), csv_number(r.poisson_ratio), cells_text(r.cells), csv_text(r.measure),
                     csv_number(r.value), csv_text(r.unit), csv_number(r.reference),
                     csv_number(r.reference_uncertainty), csv_number(r.error), r.samples, csv_number(r.spread),
                     printed ? csv_number(printed->published) : "", printed ? csv_text(printed->where) : "");
}

}  // namespace

std::string to_csv(const std::vector<CaseResult>& results) {
  std::string out =
      "case,kinematics,model,poisson_ratio,cells,measure,value,unit,reference,reference_uncertainty,error,samples,"
      "spread,published,published_where\n";
  for (const CaseResult& result : results) {
    const std::vector<PublishedRow> printed = printed_values(result);
    for (const Row& row : result.rows) {
      const auto found =
          std::find_if(printed.begin(), printed.end(), [&](const PublishedRow& p) { return printed_for(p, row); });
      out += csv_line(row, found == printed.end() ? nullptr : &*found);
    }
    for (const PublishedRow& p : printed) {
      const bool has_row =
          std::any_of(result.rows.begin(), result.rows.end(), [&](const Row& row) { return printed_for(p, row); });
      const double ours = p.computed.value_or(std::nan(""));
      if (!has_row)
        out += csv_line({p, result.experiment.name, result.experiment.kinematics, p.measure, ours, p.unit, {}, {}, {}},
                        &p);
    }
  }
  return out;
}

}  // namespace springproof
