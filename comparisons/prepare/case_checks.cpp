#include "comparisons/prepare/case_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "comparisons/judge/judge.h"
#include "comparisons/judge/measures.h"
#include "msm/measure/validity.h"
#include "msm/topology/cubic_lattice.h"
#include "problem/case_file/measures.h"
#include "problem/system/nearest_name.h"

namespace springproof {

void check_expectations(const Experiment& experiment) {
  for (const Expectation& e : experiment.expectations) {
    if (e.value || e.at_least) continue;
    if (reference_element(experiment, e.model))
      throw InputError(e.location, "value: an expectation of the reference itself needs one");
    if (e.relative && is_distance(e.measure))
      throw InputError(e.location,
                       fmt::format("within_relative: {} is expected to be 0; give an absolute `within`", e.measure));
  }
}

void check_mean_displacements(const Experiment& e, const std::vector<std::string>& patches) {
  const auto check = [&](const std::string& row, const SourceLocation& where) {
    const std::string patch = patch_of_row(row);
    if (patch.empty() || std::ranges::find(patches, patch) != patches.end()) return;
    throw InputError(where, fmt::format("measure: the body has no patch '{}' (allowed: {}){}", patch,
                                        fmt::join(patches, ", "), did_you_mean(patch, patches)));
  };
  for (const Expectation& x : e.expectations) check(x.measure, x.location);
  for (const PublishedValue& v : e.published) check(v.measure, v.location);
  for (const MeasuredValue& m : e.measured) check(m.quantity, m.where);
}

namespace {

using FacetKey = std::array<int, 4>;

FacetKey key_of(FacetKey facet) {
  std::ranges::sort(facet);
  return facet;
}

/// What holds a node or a facet of the surface, along each axis: the number of a load, -1: none.
using Holders = std::array<int, 3>;

/// The loads that hold facets of the surface.
std::map<FacetKey, Holders> held_facets(const Experiment& e, const Mesh& surface) {
  std::map<FacetKey, Holders> held;
  for (std::size_t i = 0; i < e.loads.size(); ++i) {
    if (!prescribes_displacement(e.loads[i])) continue;
    const PrescribedValue value = prescribed_displacement(e.loads[i], Vec3::Zero(), Kinematics::linear);
    for (const FacetKey& facet : patch(surface, *patch_of(e.loads[i])).facets) {
      Holders& at = held.try_emplace(key_of(facet), Holders{-1, -1, -1}).first->second;
      for (int d = 0; d < 3; ++d)
        if (value[d]) at[d] = static_cast<int>(i);
    }
  }
  return held;
}

/// Axes along which a load pulls or presses its patch.
std::array<bool, 3> pulled_axes(const Load& load) {
  Vec3 pull = Vec3::Zero();
  if (const auto* t = std::get_if<Traction>(&load)) pull = t->traction;
  if (const auto* f = std::get_if<PatchForce>(&load)) pull = f->force;
  if (const auto* p = std::get_if<Pressure>(&load); p && p->pressure != 0) pull = Vec3::Ones();
  return {pull[0] != 0, pull[1] != 0, pull[2] != 0};
}

/// The load that holds all of the patch of load number `i` along the axes of its force, or the last of these; -1: none.
int holder_of_all(const Experiment& e, std::size_t i, const Mesh& surface, const std::map<FacetKey, Holders>& held) {
  const std::array<bool, 3> axes = pulled_axes(e.loads[i]);
  int holder = -1;
  if (!axes[0] && !axes[1] && !axes[2]) return -1;
  for (const FacetKey& facet : patch(surface, *patch_of(e.loads[i])).facets) {
    const auto at = held.find(key_of(facet));
    for (int d = 0; d < 3; ++d) {
      if (!axes[d]) continue;
      if (at == held.end() || at->second[d] < 0) return -1;
      holder = at->second[d];
    }
  }
  return holder;
}

constexpr double harmless_strain = 0.01;
constexpr double in_places = 1.25;  // a body is strained by so much more than on average
constexpr double near = 1e-9;       // of the body's size: supports that far apart impose no strain

/// Nominal strains along the axes that pairs of moved supports impose, the most negative and the most positive
/// (msm/measure/validity.h); 0: none.
struct ImposedStrain {
  double compression = 0, tension = 0;
};

ImposedStrain imposed_strain(const PreparedCase& prepared) {
  struct Support {
    Vec3 at;
    const PrescribedDisplacement* moved;
  };
  const Mesh& mesh = *prepared.lattices.front().mesh;
  std::vector<Support> supports;
  for (const Load& load : prepared.loads)
    if (const auto* moved = std::get_if<PrescribedDisplacement>(&load))
      supports.push_back({centroid(mesh, patch(mesh, moved->on)), moved});
  ImposedStrain imposed;
  for (const Support& a : supports)
    for (const Support& b : supports)
      for (int axis = 0; axis < 3; ++axis) {
        const auto from = a.moved->displacement[axis], to = b.moved->displacement[axis];
        const double apart = b.at[axis] - a.at[axis];
        if (!from || !to || apart < near * prepared.body.size.norm()) continue;
        imposed.compression = std::min(imposed.compression, (*to - *from) / apart);
        imposed.tension = std::max(imposed.tension, (*to - *from) / apart);
      }
  return imposed;
}

/// Whether strain_limit() knows the model.
bool is_of_cells(const ModelParameters& p) {
  return p.row.topology == Topology::cells && !p.has(Extension::momentum_dispersion) && !p.cut.value_or(false);
}

std::optional<LatticeLimit> limit_of(const ModelParameters& p, const IsotropicMaterial& material, double strain) {
  const auto free = strain_limit(p, material, Sides::free, in_places * strain),
             held = strain_limit(p, material, Sides::held, in_places * strain);
  if (!free && !held) return {};
  LatticeLimit limit;
  limit.poisson_ratio = material.poisson_ratio;
  limit.imposed = strain;
  if (free) limit.free = free->strain;
  if (held) limit.held = held->strain;
  limit.wave = describe_wave(free ? free->k : held->k);
  return limit;
}

}  // namespace

void check_supports(const Experiment& e, const Mesh& surface) {
  std::map<int, std::pair<int, double>> moved;  // unknown -> load and displacement [m]
  const double size = (surface.nodes.colwise().maxCoeff() - surface.nodes.colwise().minCoeff()).norm();
  for (std::size_t i = 0; i < e.loads.size(); ++i) {
    if (!prescribes_displacement(e.loads[i])) continue;
    const std::string& name = *patch_of(e.loads[i]);
    for (const int node : nodes_of(patch(surface, name))) {
      const Vec3 X = surface.nodes.row(node).transpose();
      const PrescribedValue value = prescribed_displacement(e.loads[i], X, e.model_kinematics());
      for (int d = 0; d < 3; ++d) {
        if (!value[d]) continue;
        const auto [load, u] = moved.try_emplace(3 * node + d, static_cast<int>(i), *value[d]).first->second;
        if (std::abs(u - *value[d]) <= 1e-9 * size) continue;
        throw InputError(
            e.load_locations[i],
            fmt::format(
                "load: '{}' has the displacement {} = {} at {}, where '{}' of the load in line {} has {} (allowed: one "
                "displacement at each place of the surface)",
                name, "xyz"[d], text(*value[d], e.units), text(X, e.units), *patch_of(e.loads[load]),
                e.load_locations[load].line, text(u, e.units)));
      }
    }
  }
  const std::map<FacetKey, Holders> held = held_facets(e, surface);
  for (std::size_t i = 0; i < e.loads.size(); ++i)
    if (const int holder = patch_of(e.loads[i]) ? holder_of_all(e, i, surface, held) : -1; holder >= 0)
      throw InputError(
          e.load_locations[i],
          fmt::format("load: the force on '{}' acts where the load in line {} holds '{}': it would only add "
                      "to the reaction there (allowed: a force on a part of the surface that is free)",
                      *patch_of(e.loads[i]), e.load_locations[holder].line, *patch_of(e.loads[holder])));
}

std::vector<LatticeLimit> lattice_limits(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  std::vector<LatticeLimit> limits;
  if (e.model_kinematics() == Kinematics::linear || prepared.lattices.empty()) return limits;
  const auto of_boxes = [](const Lattice& l) { return l.mesh->grid && !has_cubes(*l.mesh->grid); };
  if (std::ranges::any_of(prepared.lattices, of_boxes)) return limits;  // known of cubes
  const ImposedStrain imposed = imposed_strain(prepared);
  const ModelParameters recommended = resolve({"hybmss_avg", {}, "hybmss_avg", {}});
  for (std::size_t m = 0; m < prepared.models.size(); ++m) {
    if (is_external(e.models[m]) || !is_of_cells(prepared.models[m])) continue;
    for (const IsotropicMaterial& material : e.materials)
      for (const double strain : {std::max(imposed.compression, -0.75), imposed.tension}) {
        if (std::abs(strain) < harmless_strain) continue;
        auto limit = limit_of(prepared.models[m], material, strain);
        if (!limit) continue;
        limit->model = e.models[m].label;
        if (prepared.models[m].row.name != recommended.row.name && !limit_of(recommended, material, strain))
          limit->instead = recommended.row.name;
        limits.push_back(*limit);
      }
  }
  return limits;
}

}  // namespace springproof
