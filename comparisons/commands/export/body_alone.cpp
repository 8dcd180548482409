#include "comparisons/commands/export/export_request.h"

#include <fmt/format.h>

#include <stdexcept>

#include "meshes/locate/outer_facets.h"
#include "msm/parameters/model_table.h"

namespace springproof {
namespace {

constexpr int default_voxels = 2000;

/// Sides are named as they are, other rules STEM, STEM_2, ...
std::vector<PatchRule> rules_of(const std::string& option, const std::string& stem,
                                const std::vector<std::string>& texts) {
  std::vector<PatchRule> rules;
  int others = 0;
  for (const std::string& text : texts) {
    std::string name = text;
    if (text.find('=') != std::string::npos) name = ++others == 1 ? stem : fmt::format("{}_{}", stem, others);
    rules.push_back(parse_patch_rule(name, text, option));
  }
  return rules;
}

std::vector<PatchRule> held_rules(const ExportRequest& request) { return rules_of("--hold", "held", request.hold); }

}  // namespace

ModelChoice named_model(const std::string& name) { return {name, {}, name, {}}; }

Experiment body_alone(const ExportRequest& request) {
  Experiment e;
  e.file = request.what;
  e.name = e.file.stem().string();
  e.body.geo = e.file.filename().string();
  e.body.scale = request.scale;
  if (e.body.is_script() && request.size.empty())
    throw InputError(fmt::format("{}: a script needs its size (allowed: --size X Y Z [m])", request.what));
  if (!request.size.empty()) e.body.size = Vec3(request.size[0], request.size[1], request.size[2]);
  try {
    e.materials = {material_from(request.moduli, request.density)};
  } catch (const std::invalid_argument& error) {
    throw InputError(
        fmt::format("{}: {} (a body alone needs -E and --nu, or another two moduli)", request.what, error.what()));
  }
  e.models = {named_model(request.model.empty() ? recommended_model().name : request.model)};
  e.patches = held_rules(request);
  for (PatchRule& rule : rules_of("--load", "loaded", request.load)) e.patches.push_back(std::move(rule));
  if (!request.cells) e.body.voxel_counts = {request.voxels.value_or(default_voxels)};
  return e;
}

std::vector<std::string> held_patches(const ExportRequest& request) {
  std::vector<std::string> names;
  for (const PatchRule& rule : held_rules(request)) names.push_back(rule.name);
  return names;
}

void refuse_whole_surface(const PreparedCase& prepared) {
  const bool block = prepared.body.tetrahedra.empty();
  const Mesh& body = block ? *prepared.lattices.front().mesh : *prepared.body.tetrahedra.back();
  const std::size_t facets = outer_facets(body).size();
  for (const PatchRule& rule : prepared.experiment.patches)
    if (patch(body, rule.name).facets.size() == facets)
      throw InputError(rule.where, fmt::format("'{}' takes the whole surface (allowed: a part of it)", rule.name));
}

}  // namespace springproof
