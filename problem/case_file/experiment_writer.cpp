#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "problem/case_file/experiment.h"

namespace springproof {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      result += {'\\', c};
    else if (code < 0x20 || code == 0x7f)
      result += fmt::format("\\u{:04X}", code);
    else
      result += c;
  }
  return result + "\"";
}

/// Shortest text that reads back to the same bits; "-0" would be read as an integer, which has no sign.
std::string number(double x) { return x == 0 && std::signbit(x) ? "-0.0" : fmt::format("{}", x); }

template <class Numbers>
std::string list(const Numbers& numbers) {
  std::vector<std::string> items;
  for (const double x : numbers) items.push_back(number(x));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

std::string row(const Vec3& v) { return list(v); }

std::string row(const Cells& cells) { return fmt::format("[{}]", fmt::join(cells, ", ")); }

class Writer {
 public:
  void heading(const std::string& text) { out_ += "\n" + text + "\n"; }
  void line(const std::string& key, const std::string& value) { out_ += fmt::format("{} = {}\n", key, value); }
  void text(const std::string& key, const std::string& value) {
    if (!value.empty()) line(key, quoted(value));
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

void write_body(const Body& body, Writer& out) {
  out.heading("[body]");
  out.text("geo", body.geo);
  if (body.is_script())
    out.line("size_m", row(body.size));
  else
    out.line("scale", number(body.scale));
  std::vector<std::string> cells;
  for (const Cells& c : body.cells) cells.push_back(row(c));
  if (!body.voxel_counts.empty())
    out.line("voxels", fmt::format("[{}]", fmt::join(body.voxel_counts, ", ")));
  else if (!body.voxel_edges.empty())
    out.line("voxel_edge_m", list(body.voxel_edges));
  else
    out.line("cells", fmt::format("[{}]", fmt::join(cells, ", ")));
}

void write_patch_rule(const PatchRule& rule, Writer& out) {
  out.heading("[[patch]]");
  out.text("name", rule.name);
  if (rule.box) out.line("box_m", fmt::format("[{}, {}]", row(rule.box->low), row(rule.box->high)));
  if (rule.beyond)
    out.line("beyond",
             fmt::format("{{ point_m = {}, normal = {} }}", row(rule.beyond->point), row(rule.beyond->normal)));
  if (rule.facing)
    out.line("facing", fmt::format("{{ direction = {}, within_deg = {} }}", row(rule.facing->direction),
                                   number(rule.facing->within_deg)));
  if (rule.near)
    out.line("near",
             fmt::format("{{ point_m = {}, radius_m = {} }}", row(rule.near->point), number(rule.near->radius)));
}

void write_materials(const std::vector<IsotropicMaterial>& materials, Writer& out) {
  std::vector<double> E, nu;
  for (const IsotropicMaterial& m : materials) {
    E.push_back(m.youngs_modulus);
    nu.push_back(m.poisson_ratio);
  }
  out.heading("[material]");
  out.line("youngs_modulus_Pa", list(E));
  out.line("poisson_ratio", list(nu));
  if (!materials.empty()) out.line("density_kg_m3", number(materials.front().density));
}

void write_load(const PrescribedDisplacement& load, Writer& out) {
  std::vector<std::string> components;
  for (const auto& u : load.displacement) components.push_back(u ? number(*u) : "\"free\"");
  out.line("displacement_m", fmt::format("[{}]", fmt::join(components, ", ")));
}

void write_load(const PrescribedAffine& load, Writer& out) {
  const Eigen::Matrix3d& H = load.gradient;
  out.line("displacement_gradient",
           fmt::format("[{}, {}, {}]", row(Vec3(H.row(0))), row(Vec3(H.row(1))), row(Vec3(H.row(2)))));
  out.line("displacement_m", row(load.offset));
}

void write_load(const PrescribedRotation& load, Writer& out) {
  out.line("rotation_deg", number(load.angle * 180 / std::numbers::pi));
  out.line("axis", row(load.axis));
  out.line("about_m", row(load.point));
}

void write_load(const PrescribedField& load, Writer& out) { out.text("field", load.field); }
void write_load(const FieldBodyForce& load, Writer& out) { out.text("body_force_of", load.field); }
void write_load(const Pressure& load, Writer& out) { out.line("pressure_Pa", number(load.pressure)); }
void write_load(const Traction& load, Writer& out) { out.line("traction_Pa", row(load.traction)); }
void write_load(const PatchForce& load, Writer& out) { out.line("force_N", row(load.force)); }
void write_load(const Gravity& load, Writer& out) { out.line("gravity_m_s2", row(load.acceleration)); }

void write_load(const PointForce& load, Writer& out) {
  out.line("force_N", row(load.force));
  out.line("at_m", row(load.at));
}

std::string model_table(const ModelChoice& choice) {
  std::string table = fmt::format("{{ model = {}, label = {}", quoted(choice.name), quoted(choice.label));
  for (const auto& [name, value] : choice.options) {
    table += ", " + quoted(name) + " = ";
    if (const bool* flag = std::get_if<bool>(&value)) table += *flag ? "true" : "false";
    if (const double* x = std::get_if<double>(&value)) table += number(*x);
    if (const std::string* text = std::get_if<std::string>(&value)) table += quoted(*text);
  }
  return table + " }";
}

std::string list_of(const std::vector<std::string>& names) {
  std::vector<std::string> items;
  for (const std::string& name : names) items.push_back(quoted(name));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

void write_compare(const Experiment& experiment, Writer& out) {
  std::vector<std::string> models;
  for (const ModelChoice& choice : experiment.models) models.push_back(model_table(choice));
  out.heading("[compare]");
  out.line("models", fmt::format("[{}]", fmt::join(models, ", ")));
  out.line("measures", list_of(experiment.measures));
  out.line("elements", list_of(experiment.elements));
  if (experiment.most_unknowns > 0) out.line("most_unknowns", number(experiment.most_unknowns));
  if (experiment.cost) out.line("cost", "true");
  out.text("exact", experiment.exact);
}

void write_expectation(const Expectation& expect, Writer& out) {
  out.heading("[[expect]]");
  out.text("model", expect.model);
  if (expect.poisson_ratio) out.line("poisson_ratio", number(*expect.poisson_ratio));
  if (expect.cells) out.line("cells", row(*expect.cells));
  out.text("measure", expect.measure);
  out.text("source", to_string(expect.source));
  if (expect.value) out.line("value", number(*expect.value));
  if (expect.at_least)
    out.line("at_least", number(*expect.at_least));
  else
    out.line(expect.relative ? "within_relative" : "within", number(expect.within));
  out.text("where", expect.where);
}

void write_published(const PublishedValue& printed, Writer& out) {
  out.heading("[[published]]");
  out.text("model", printed.model);
  out.line("poisson_ratio", number(printed.poisson_ratio));
  if (printed.cells) out.line("cells", row(*printed.cells));
  out.text("measure", printed.measure);
  out.line("value", number(printed.value));
  out.text("where", printed.where);
  out.text("remark", printed.remark);
}

}  // namespace

std::string to_toml(const Experiment& experiment) {
  Writer out;
  out.text("cite", experiment.cite);
  out.text("what", experiment.what);
  out.text("kinematics", experiment.kinematics);
  write_body(experiment.body, out);
  for (const PatchRule& rule : experiment.patches) write_patch_rule(rule, out);
  write_materials(experiment.materials, out);
  for (const Load& load : experiment.loads) {
    out.heading("[[load]]");
    if (const std::string* on = patch_of(load)) out.text("on", *on);
    std::visit([&](const auto& l) { write_load(l, out); }, load);
  }
  write_compare(experiment, out);
  if (experiment.section) {
    out.heading("[section]");
    out.line("point_m", row(experiment.section->point));
    out.line("normal", row(experiment.section->normal));
  }
  if (experiment.line) {
    out.heading("[line]");
    out.line("from_m", row(experiment.line->from));
    out.line("to_m", row(experiment.line->to));
    out.line("points", fmt::format("{}", experiment.line->points));
    out.line("middle", fmt::format("[{}]", fmt::join(experiment.line->middle, ", ")));
  }
  for (const Probe& probe : experiment.probes) {
    out.heading("[[probe]]");
    out.text("name", probe.name);
    out.line("at_m", row(probe.at));
  }
  out.heading("[reference]");
  if (experiment.reference.cells[0] > 0) out.line("cells", row(experiment.reference.cells));
  out.line("elements", list_of(experiment.reference.elements));
  if (!experiment.body.is_voxels()) out.line("grading", number(experiment.reference.grading));
  if (experiment.reference.edge > 0) out.line("edge_m", number(experiment.reference.edge));
  if (experiment.reference.smooth) out.line("smooth", "true");
  for (const Expectation& expect : experiment.expectations) write_expectation(expect, out);
  for (const PublishedValue& printed : experiment.published) write_published(printed, out);
  return out.take();
}

}  // namespace springproof
