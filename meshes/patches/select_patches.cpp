#include "meshes/patches/select_patches.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "meshes/facets.h"
#include "meshes/locate/facet_tree.h"
#include "meshes/patches/imprint.h"
#include "meshes/patches/rule_region.h"

namespace springproof {
namespace {

constexpr double selection_tolerance = 1e-9;  // of the body: boundaries belong to what is selected

/// The outer facets and what rules look at.
struct Facets {
  std::vector<OuterFacet> facets;
  std::vector<Vec3> middle, normal;
  Box box;

  double slack() const { return selection_tolerance * (box.high - box.low).norm(); }
};

Facets facets_of(const Mesh& mesh) {
  Facets s{outer_facets(mesh), {}, {}, empty_box()};
  for (const OuterFacet& f : s.facets) {
    Vec3 x[4];
    for (int c = 0; c < corners_of(f.nodes); ++c) {
      x[c] = mesh.nodes.row(f.nodes[c]).transpose();
      add_to(s.box, x[c]);
    }
    s.middle.push_back(middle_of(mesh, f.nodes));
    s.normal.push_back(corners_of(f.nodes) == 3 ? (x[1] - x[0]).cross(x[2] - x[0]).normalized()
                                                : (x[2] - x[0]).cross(x[3] - x[1]).normalized());
  }
  return s;
}

/// How far each facet is from meeting a condition; it does at 0.
using Miss = std::function<double(std::size_t facet)>;

Miss miss_of(const PatchRule::Box& box, const Facets& s) {
  return [&](std::size_t f) {
    const double off = (box.low - s.middle[f]).cwiseMax(s.middle[f] - box.high).cwiseMax(0).norm();
    return off <= s.slack() ? 0 : off;
  };
}

Miss miss_of(const PatchRule::Beyond& plane, const Facets& s) {
  return [&](std::size_t f) {
    const double short_by = plane.normal.dot(plane.point - s.middle[f]);
    return short_by <= s.slack() ? 0 : short_by;
  };
}

Miss miss_of(const PatchRule::Facing& facing, const Facets& s) {
  return [&](std::size_t f) {
    const double angle = std::atan2(s.normal[f].cross(facing.direction).norm(), s.normal[f].dot(facing.direction)) *
                         180 / std::numbers::pi;
    return angle <= facing.within_deg * (1 + selection_tolerance) ? 0 : angle - facing.within_deg;
  };
}

/// Facets of `near` by edges from the nearest one.
Miss miss_of(const PatchRule::Near& near, const Facets& s, const Mesh& mesh) {
  const FacetTree::Nearest nearest = FacetTree(mesh, s.facets).nearest(near.point);
  std::vector<std::pair<std::pair<int, int>, int>> edges;  // and a facet that has it
  for (std::size_t f = 0; f < s.facets.size(); ++f) {
    if (f != nearest.facet && (s.middle[f] - nearest.point).norm() > near.radius + s.slack()) continue;
    for (int c = 0; c < corners_of(s.facets[f].nodes); ++c)
      edges.emplace_back(edge_of(s.facets[f].nodes, c), static_cast<int>(f));
  }
  UnitedNumbers piece(s.facets.size());
  unite_by_key(std::move(edges), piece);
  return [piece, first = piece.of(static_cast<int>(nearest.facet))](std::size_t f) mutable {
    return piece.of(static_cast<int>(f)) == first ? 0.0 : 1.0;
  };
}

struct Condition {
  const char* key;
  const char* nearest;  ///< what the least miss is, for the message
  Miss miss;
};

std::vector<Condition> conditions_of(const PatchRule& rule, const Facets& s, const Mesh& mesh) {
  std::vector<Condition> list;
  if (rule.box)
    list.push_back({"box_m", "the nearest one has its middle {:.4g} m from the box", miss_of(*rule.box, s)});
  if (rule.beyond)
    list.push_back({"beyond", "the nearest one has its middle {:.4g} m short of the plane", miss_of(*rule.beyond, s)});
  if (rule.facing)
    list.push_back({"facing", "the nearest one is turned {:.4g} degrees too far away", miss_of(*rule.facing, s)});
  if (rule.near) list.push_back({"near", "", miss_of(*rule.near, s, mesh)});
  return list;
}

/// What one condition alone holds.
std::string account_of(const Condition& condition, const Facets& s) {
  double least = std::numeric_limits<double>::infinity();
  std::size_t met = 0;
  for (std::size_t f = 0; f < s.facets.size(); ++f) {
    const double miss = condition.miss(f);
    least = std::min(least, miss);
    met += miss == 0;
  }
  if (met > 0) return fmt::format("{} holds for {} of {}", condition.key, met, s.facets.size());
  return fmt::format("{} holds for none, {}", condition.key, fmt::format(fmt::runtime(condition.nearest), least));
}

[[noreturn]] void refuse_empty(const PatchRule& rule, const std::vector<Condition>& conditions, const Facets& s) {
  std::vector<std::string> accounts;
  for (const Condition& condition : conditions) accounts.push_back(account_of(condition, s));
  throw InputError(
      rule.where,
      fmt::format("patch: '{}' selects no facet of the surface: {} (the body spans ({:.6g}, {:.6g}, {:.6g}) to "
                  "({:.6g}, {:.6g}, {:.6g}) m)",
                  rule.name, fmt::join(accounts, "; "), s.box.low[0], s.box.low[1], s.box.low[2], s.box.high[0],
                  s.box.high[1], s.box.high[2]));
}

Patch selected(const PatchRule& rule, const Facets& s, const Mesh& mesh) {
  const std::vector<Condition> conditions = conditions_of(rule, s, mesh);
  Patch patch{rule.name, {}};
  for (std::size_t f = 0; f < s.facets.size(); ++f)
    if (std::all_of(conditions.begin(), conditions.end(), [&](const Condition& c) { return c.miss(f) == 0; }))
      patch.facets.push_back(s.facets[f].nodes);
  if (patch.facets.empty()) refuse_empty(rule, conditions, s);
  return patch;
}

void refuse_taken(const PatchRule& rule, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), rule.name) == names.end()) return;
  throw InputError(rule.where,
                   fmt::format("patch.name: the body already has a patch '{}' (allowed: a name other than {})",
                               rule.name, fmt::join(names, ", ")));
}

}  // namespace

std::vector<std::string> select_patches(const std::vector<PatchRule>& rules, Mesh& mesh, double coarseness) {
  if (rules.empty()) return {};
  std::vector<std::string> names;
  for (const Patch& p : mesh.patches) names.push_back(p.name);
  const Facets facets = facets_of(mesh);
  const Surface surface = outside_of(mesh, facets.facets);
  CutMesh cut(mesh);
  for (const PatchRule& given : rules) {
    const PatchRule rule = settled(given, surface);
    refuse_taken(rule, names);
    if (mesh.tetrahedra.empty())
      mesh.patches.push_back(selected(rule, facets, mesh));
    else if (imprint(rule, static_cast<int>(names.size()), coarseness, cut) == 0)
      refuse_empty(rule, conditions_of(rule, facets, mesh), facets);
    names.push_back(rule.name);
  }
  if (mesh.tetrahedra.empty()) return {};
  const std::size_t before = mesh.tetrahedra.size();
  mesh = cut.mesh(names);
  if (cut.cells() == before) return {};
  return {fmt::format("the borders of the patches cut {} tetrahedra into {}; worst shape 6 sqrt(2) V / edge^3 = {:.2g}",
                      before, cut.cells(), cut.worst_shape())};
}

namespace {

double area_of(const Surface& s, std::size_t triangle) {
  const auto& [a, b, c] = s.triangles[triangle];
  return (s.points[b] - s.points[a]).cross(s.points[c] - s.points[a]).norm() / 2;
}

/// Of the outer facets of hexahedra, each two triangles of the surface, how many a rule cuts.
std::size_t facets_cut(const PatchRule& rule, const Surface& surface) {
  constexpr double whole = 1e-6;  // of a facet's area
  const std::vector<FacetPart> parts = parts_within(rule_region(rule, surface), surface);
  std::size_t cut = 0;
  for (std::size_t f = 0; f + 1 < parts.size(); f += 2) {
    const double share =
        (parts[f].area.norm() + parts[f + 1].area.norm()) / (area_of(surface, f) + area_of(surface, f + 1));
    cut += share > whole && share < 1 - whole;
  }
  return cut;
}

}  // namespace

bool end_at_edges_of(const Mesh& mesh, const std::vector<PatchRule>& rules) {
  if (rules.empty() || !mesh.tetrahedra.empty()) return true;
  const Surface surface = outside_of(mesh);
  return std::all_of(rules.begin(), rules.end(), [&](const PatchRule& rule) { return facets_cut(rule, surface) == 0; });
}

void select_whole_facets(const std::vector<PatchRule>& rules, Mesh& mesh) {
  if (!rules.empty() && mesh.tetrahedra.empty()) {
    const Surface surface = outside_of(mesh);
    for (const PatchRule& rule : rules)
      if (const std::size_t cut = facets_cut(rule, surface))
        throw InputError(rule.where,
                         fmt::format("patch: the border of '{}' runs through {} facets of a grid with {} cells, so it "
                                     "would be another patch on each grid (allowed: borders along the lines of every "
                                     "grid, those of the reference too; or a body of voxels, whose facets are cut)",
                                     rule.name, cut, mesh.hexahedra.size()));
  }
  select_patches(rules, mesh);
}

}  // namespace springproof
