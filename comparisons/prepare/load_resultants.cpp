#include "comparisons/prepare/load_resultants.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "meshes/patches/rule_region.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

constexpr double least_spread = 1e-6;  // of an area or a volume between the meshes, above which it is reported

/// The rule of this name; none: the patch is named in the file.
const PatchRule* rule_of(const PreparedCase& prepared, const std::string& name) {
  const std::vector<PatchRule>& rules = prepared.experiment.patches;
  const auto rule = std::ranges::find_if(rules, [&](const PatchRule& r) { return r.name == name; });
  return rule == rules.end() ? nullptr : &*rule;
}

/// What a rule names of the file's facets; nothing without these, or where it goes by normals, which noise turns.
std::vector<FacetPart> parts_of_file(const PreparedCase& prepared, const PatchRule& rule) {
  if (!prepared.body.facets) return {};
  const PatchRule as_on_the_mesh = settled(rule, outside_of(*prepared.body.tetrahedra.back()));
  if (as_on_the_mesh.facing) return {};
  return parts_of(as_on_the_mesh, *prepared.body.facets);
}

/// The facets of a patch: for a patch by a rule its part of each facet, of the file or the finest mesh, cut at the
/// border; for others whole facets.
std::vector<FacetPart> parts_of(const PreparedCase& prepared, const std::string& name) {
  const Mesh& mesh = *prepared.body.tetrahedra.back();
  if (const PatchRule* rule = rule_of(prepared, name)) {
    std::vector<FacetPart> of_file = parts_of_file(prepared, *rule);
    return of_file.empty() ? parts_of(*rule, mesh) : of_file;
  }
  const auto X = [&](int n) -> Vec3 { return mesh.nodes.row(n).transpose(); };
  std::vector<FacetPart> parts;
  for (const auto& f : patch(mesh, name).facets) {
    const Vec3 a = X(f[0]), b = X(f[1]), c = X(f[2]);
    parts.push_back({(b - a).cross(c - a) / 2, (a + b + c) / 3, {}});
  }
  return parts;
}

double area(const std::vector<FacetPart>& parts) {
  double sum = 0;
  for (const FacetPart& p : parts) sum += p.area.norm();
  return sum;
}

Vec3 centroid(const std::vector<FacetPart>& parts) {
  Vec3 sum = Vec3::Zero();
  for (const FacetPart& p : parts) sum += p.area.norm() * p.centroid;
  return sum / area(parts);
}

Wrench of_pressure(const std::vector<FacetPart>& parts, double pressure) {
  Wrench wrench{Vec3::Zero(), Vec3::Zero(), centroid(parts)};
  for (const FacetPart& p : parts) {
    wrench.force -= pressure * p.area;
    wrench.moment -= pressure * (p.centroid - wrench.about).cross(p.area);
  }
  return wrench;
}

Vec3 centroid(const Mesh& mesh) {
  const Eigen::VectorXd volumes = nodal_volumes(mesh);
  return mesh.nodes.transpose() * volumes / volumes.sum();
}

/// The weight of tetrahedra of several densities, about their centre of mass.
Wrench weight_of_regions(const PreparedCase& prepared, const Vec3& acceleration) {
  const Mesh& body = *prepared.body.tetrahedra.back();
  const Eigen::VectorXd volumes = cell_volumes(body, body.nodes);
  double mass = 0;
  Vec3 moment = Vec3::Zero();
  for (std::size_t c = 0; c < body.tetrahedra.size(); ++c) {
    const std::uint8_t material = body.materials[c];
    const Experiment& e = prepared.experiment;
    const double own = volumes[static_cast<Eigen::Index>(c)] *
                       (material == 0 ? e.materials.front() : e.regions[material - 1].material).density;
    mass += own;
    for (const int n : body.tetrahedra[c]) moment += own / 4 * body.nodes.row(n).transpose();
  }
  return {mass * acceleration, Vec3::Zero(), moment / mass};
}

/// The weight's resultant, of the body within the file's facets where there are such.
Wrench weight(const PreparedCase& prepared, const Vec3& acceleration) {
  if (!prepared.body.tetrahedra.back()->materials.empty()) return weight_of_regions(prepared, acceleration);
  const double density = prepared.experiment.materials.front().density;
  if (prepared.body.facets)
    return {density * volume(*prepared.body.facets) * acceleration, Vec3::Zero(), centroid(*prepared.body.facets)};
  const Mesh& body = *prepared.body.tetrahedra.back();
  return {density * volume(body, body.nodes) * acceleration, Vec3::Zero(), centroid(body)};
}

void set_wrenches(PreparedCase& prepared) {
  const auto parts = [&](const std::string& name) { return parts_of(prepared, name); };
  for (const PatchRule& rule : prepared.experiment.patches)
    if (const std::vector<FacetPart> of_file = parts_of_file(prepared, rule); !of_file.empty())
      prepared.body.centroids[rule.name] = centroid(of_file);
  const auto at_centroid = [](const Vec3& force, const Vec3& c) { return Wrench{force, Vec3::Zero(), c}; };
  const std::size_t own = prepared.loads.size() - prepared.experiment.weights;  // masses weigh where their inertia is
  for (Load& load : std::span(prepared.loads).first(own)) {
    if (auto* t = std::get_if<Traction>(&load)) {
      t->wrench = at_centroid(area(parts(t->on)) * t->traction, centroid(parts(t->on)));
    } else if (auto* q = std::get_if<Pressure>(&load)) {
      q->wrench = of_pressure(parts(q->on), q->pressure);
    } else if (auto* f = std::get_if<PatchForce>(&load)) {
      f->wrench = at_centroid(f->force, centroid(parts(f->on)));
    } else if (auto* g = std::get_if<Gravity>(&load); g && !flies(prepared.experiment)) {
      g->wrench = weight(prepared, g->acceleration);
    }
  }
}

/// Relative difference of a quantity between the two finest meshes; 0: there is one.
double spread(const PreparedCase& prepared, const std::function<double(const Mesh&)>& quantity) {
  const auto& meshes = prepared.body.tetrahedra;
  return meshes.size() < 2 ? 0 : std::abs(quantity(*meshes[meshes.size() - 2]) / quantity(*meshes.back()) - 1);
}

/// Sets the uncertainty of loads proportional to an area or a volume, as every mesh carries the resultants of the
/// finest, or of the file's facets, which are certain.
void set_load_spread(PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  for (const Load& load : e.loads) {
    const std::string* on = patch_of(load);
    const bool by_area = std::holds_alternative<Traction>(load) || std::holds_alternative<Pressure>(load);
    if (!by_area && (!std::holds_alternative<Gravity>(load) || flies(e))) continue;
    if (on ? prepared.body.centroids.contains(*on) : prepared.body.facets != nullptr) continue;
    const double off =
        spread(prepared, [&](const Mesh& m) { return on ? nodal_areas(m, patch(m, *on)).sum() : volume(m, m.nodes); });
    if (off <= least_spread) continue;
    prepared.body.load_spread = std::max(prepared.body.load_spread, off);
    prepared.body.notes.push_back(
        fmt::format("the meshes differ by {:.2g} % in {}: so much is added to the uncertainties", 100 * off,
                    on ? "the area of patch '" + *on + "'" : "their volume, and so the weight"));
  }
}

}  // namespace

bool flies(const Experiment& e) { return e.dynamics && std::ranges::none_of(e.loads, prescribes_displacement); }

std::vector<PatchReaction> about_true_patches(const PreparedCase& prepared, const Mesh& own,
                                              std::vector<PatchReaction> reactions) {
  const Mesh& body = *prepared.body.tetrahedra.back();
  for (PatchReaction& r : reactions) {
    const auto of_file = prepared.body.centroids.find(r.patch);
    const Vec3 about =
        of_file != prepared.body.centroids.end() ? of_file->second : centroid(body, patch(body, r.patch));
    r.torque += (centroid(own, patch(own, r.patch)) - about).cross(r.force);
  }
  return reactions;
}

void set_resultants(PreparedCase& prepared) {
  set_wrenches(prepared);
  set_load_spread(prepared);
}

}  // namespace springproof
