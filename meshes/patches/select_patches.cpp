#include "meshes/patches/select_patches.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

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
  Vec3 low, high;

  double slack() const { return selection_tolerance * (high - low).norm(); }
};

Facets facets_of(const Mesh& mesh) {
  Facets s{outer_facets(mesh), {}, {}, Vec3::Constant(std::numeric_limits<double>::infinity()), {}};
  s.high = -s.low;
  for (const OuterFacet& f : s.facets) {
    const int corners = f.nodes[3] < 0 ? 3 : 4;
    Vec3 x[4], middle = Vec3::Zero();
    for (int c = 0; c < corners; ++c) {
      x[c] = mesh.nodes.row(f.nodes[c]).transpose();
      middle += x[c] / corners;
      s.low = s.low.cwiseMin(x[c]);
      s.high = s.high.cwiseMax(x[c]);
    }
    s.middle.push_back(middle);
    s.normal.push_back(corners == 3 ? (x[1] - x[0]).cross(x[2] - x[0]).normalized()
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

/// Which of the facets `in` are connected with `first` through edges.
std::vector<char> piece_with(std::size_t first, const std::vector<char>& in, const std::vector<OuterFacet>& facets) {
  std::vector<std::pair<std::pair<int, int>, std::size_t>> edges;  // and a facet that has it
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto& n = facets[f].nodes;
    const int corners = n[3] < 0 ? 3 : 4;
    for (int c = 0; in[f] && c < corners; ++c) edges.emplace_back(std::minmax(n[c], n[(c + 1) % corners]), f);
  }
  std::sort(edges.begin(), edges.end());
  std::vector<char> piece(facets.size(), 0);
  std::vector<std::size_t> todo = {first};
  piece[first] = 1;
  while (!todo.empty()) {
    const auto& n = facets[todo.back()].nodes;
    todo.pop_back();
    const int corners = n[3] < 0 ? 3 : 4;
    for (int c = 0; c < corners; ++c) {
      const std::pair<int, int> edge = std::minmax(n[c], n[(c + 1) % corners]);
      for (auto it = std::lower_bound(edges.begin(), edges.end(), std::pair(edge, std::size_t{0}));
           it != edges.end() && it->first == edge; ++it)
        if (!std::exchange(piece[it->second], 1)) todo.push_back(it->second);
    }
  }
  return piece;
}

Miss miss_of(const PatchRule::Near& near, const Facets& s, const Mesh& mesh) {
  const FacetTree::Nearest nearest = FacetTree(mesh, s.facets).nearest(near.point);
  std::vector<char> in(s.facets.size());
  for (std::size_t f = 0; f < in.size(); ++f) in[f] = (s.middle[f] - nearest.point).norm() <= near.radius + s.slack();
  in[nearest.facet] = 1;
  return [piece = piece_with(nearest.facet, in, s.facets)](std::size_t f) { return piece[f] ? 0.0 : 1.0; };
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
                  rule.name, fmt::join(accounts, "; "), s.low[0], s.low[1], s.low[2], s.high[0], s.high[1], s.high[2]));
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

}  // namespace

namespace {

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
