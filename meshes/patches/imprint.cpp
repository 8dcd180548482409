#include "meshes/patches/imprint.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "meshes/facets.h"

namespace springproof {
namespace {

// Facets across a patch in the finest mesh, and along a sphere's radius where its border runs.  A plane is the same
// border on every mesh, a circle another polygon.
constexpr double facets_within_planes = 4, facets_within_sphere = 6;
constexpr double near_end = 0.3;  // of an edge: nodes so near to a border are moved onto it where they can
constexpr double graze = 0.15;    // of an edge: what less of it reaches into a sphere is left there
constexpr double sliver = 1e-3;   // of an edge: a plane so near to a face, as a tolerance puts it, runs in the face
constexpr int most_passes = 30, passes_with_moves = 4;

struct Crossing {
  int a, b;
  double t;  ///< at a + t (b - a)
};

class Imprint {
 public:
  Imprint(const PatchRule& rule, double coarseness, CutMesh& mesh)
      : mesh_(mesh),
        region_(rule_region(rule, mesh.surface())),
        facets_((region_.sphere ? facets_within_sphere : facets_within_planes) / coarseness) {}

  std::size_t into(int patch) {
    refine();
    for (const Border& plane : region_.planes) cut(plane);
    if (region_.sphere) cut(*region_.sphere);
    const std::vector<std::size_t> inside = facets_inside();
    if (region_.sphere) match_area(inside);
    for (const std::size_t f : inside) mesh_.add_to_patch(f, patch);
    return inside.size();
  }

 private:
  const Vec3& X(int node) const { return mesh_.points()[node]; }
  const std::array<int, 3>& corners(std::size_t facet) const { return mesh_.surface().triangles[facet]; }
  bool is_on(const Border& border, int node) const { return std::abs(border.depth(X(node))) <= region_.slack; }

  bool in_sphere(std::size_t facet) const {
    if (!region_.sphere) return true;
    return std::all_of(corners(facet).begin(), corners(facet).end(),
                       [&](int n) { return region_.sphere->depth(X(n)) >= -region_.slack; });
  }

  template <class Visit>
  void for_each_part(const Visit& visit) const {
    const std::vector<FacetPart> parts = parts_within(region_, mesh_.surface());
    for (std::size_t f = 0; f < parts.size(); ++f)
      if (!parts[f].area.isZero(0)) visit(f, parts[f]);
  }

  /// Of the patch; within twice the sphere's radius.
  double extent() const {
    Box box = empty_box();
    for_each_part([&](std::size_t, const FacetPart& part) {
      for (const Vec3& x : part.polygon) add_to(box, x);
    });
    const double extent = (box.high - box.low).norm();
    return region_.sphere ? std::min(extent, 2 * region_.sphere->radius) : extent;
  }

  void refine() {
    const double across = extent() / facets_;
    std::set<std::array<int, 2>> too_long;
    do {
      too_long.clear();
      for_each_part([&](std::size_t f, const FacetPart&) {
        const double limit = in_sphere(f) ? across : std::min(across, region_.sphere->radius / facets_);
        const auto [a, b] = longest_edge(f);
        if ((X(a) - X(b)).norm() > limit) too_long.insert({std::min(a, b), std::max(a, b)});
      });
      for (const auto& [a, b] : too_long) mesh_.refine(a, b);
    } while (!too_long.empty());
  }

  std::array<int, 2> longest_edge(std::size_t facet) const {
    const auto& t = corners(facet);
    std::array<int, 2> longest = {t[0], t[1]};
    for (int c = 1; c < 3; ++c)
      if ((X(t[c]) - X(t[(c + 1) % 3])).norm() > (X(longest[0]) - X(longest[1])).norm())
        longest = {t[c], t[(c + 1) % 3]};
    return longest;
  }

  void cut(const Border& border) {
    track_.clear();
    for (int pass = 0; pass < most_passes; ++pass) {
      const std::vector<Crossing> crossings = crossings_of(border);
      if (crossings.empty()) return;
      if (pass < passes_with_moves && move_onto(border, crossings)) continue;
      bool cuts = false;
      for (const Crossing& c : crossings) {
        if (std::min(c.t, 1 - c.t) < sliver && on_face_beside(border, c.t < 0.5 ? c.a : c.b)) continue;
        const Vec3 along = X(c.b) - X(c.a);
        track_[mesh_.bisect(c.a, c.b, X(c.a) + c.t * along)] = along;
        cuts = true;
      }
      if (!cuts) return;
    }
  }

  /// Whether a facet at the node runs along the plane.
  bool on_face_beside(const Border& plane, int node) const {
    const std::vector<int>& facets = mesh_.facets_at(node);
    return !plane.is_sphere() && std::any_of(facets.begin(), facets.end(), [&](int facet) {
      const auto& t = corners(facet);
      const double edge =
          std::min({(X(t[0]) - X(t[1])).norm(), (X(t[1]) - X(t[2])).norm(), (X(t[2]) - X(t[0])).norm()});
      return std::all_of(t.begin(), t.end(), [&](int n) { return std::abs(plane.depth(X(n))) < sliver * edge; });
    });
  }

  /// Where the border cuts edges of facets that have a part of the patch.
  std::vector<Crossing> crossings_of(const Border& border) const {
    std::set<std::pair<int, int>> edges;
    for_each_part([&](std::size_t f, const FacetPart&) {
      for (int c = 0; c < 3; ++c) edges.insert(edge_of(corners(f), c));
    });
    std::vector<Crossing> crossings;
    for (const auto& [a, b] : edges)
      if (const double t = crossing(border, a, b); t > 0 && t < 1) crossings.push_back({a, b, t});
    return crossings;
  }

  /// The first place between a and b where the border cuts the edge; 0: nowhere.
  double crossing(const Border& border, int a, int b) const {
    if (border.is_sphere()) return crossing_of_sphere(border, a, b);
    const double da = border.depth(X(a)), db = border.depth(X(b));
    return is_on(border, a) || is_on(border, b) || (da > 0) == (db > 0) ? 0 : da / (da - db);
  }

  double crossing_of_sphere(const Border& sphere, int a, int b) const {
    const Vec3 d = X(b) - X(a), from = X(a) - sphere.point;
    const double A = d.squaredNorm(), B = from.dot(d),
                 discriminant = B * B - A * (from.squaredNorm() - std::pow(sphere.radius, 2));
    if (discriminant <= 0) return 0;
    const double in = (-B - std::sqrt(discriminant)) / A, out = (-B + std::sqrt(discriminant)) / A;
    const bool on_a = is_on(sphere, a), on_b = is_on(sphere, b), a_within = sphere.depth(X(a)) > 0,
               b_within = sphere.depth(X(b)) > 0;
    if (on_a && on_b) return 0;
    if (on_a) return !b_within && out > graze ? out : 0;
    if (on_b) return !a_within && in < 1 - graze ? in : 0;
    if (a_within || b_within) return a_within && b_within ? 0 : a_within ? out : in;
    return in > 0 && out < 1 && out - in > graze ? in : 0;
  }

  /// Nodes near the border, along the edges that it cuts.
  /// @return whether one was moved
  bool move_onto(const Border& border, const std::vector<Crossing>& crossings) {
    std::vector<std::pair<double, std::size_t>> ends;  // distance over the edge's length, crossing
    for (std::size_t i = 0; i < crossings.size(); ++i)
      if (const double t = std::min(crossings[i].t, 1 - crossings[i].t); t < near_end) ends.emplace_back(t, i);
    std::sort(ends.begin(), ends.end());
    std::set<int> moved;
    for (const auto& [t, i] : ends) {
      const Crossing& c = crossings[i];
      if (moved.contains(c.a) || moved.contains(c.b)) continue;
      const Vec3 along = X(c.b) - X(c.a), to = X(c.a) + c.t * along;
      const int node = c.t < 0.5 ? c.a : c.b;
      if (!keeps_planes(border, node, to) || !mesh_.slide(node, to)) continue;
      moved.insert(node);
      track_[node] = along;
    }
    return !moved.empty();
  }

  bool keeps_planes(const Border& border, int node, const Vec3& to) const {
    return std::all_of(region_.planes.begin(), region_.planes.end(), [&](const Border& plane) {
      return &plane == &border || !is_on(plane, node) || std::abs(plane.depth(to)) <= region_.slack;
    });
  }

  /// Facets in the patch but for slivers.
  std::vector<std::size_t> facets_inside() const {
    std::vector<std::size_t> inside;
    for_each_part([&](std::size_t f, const FacetPart& part) {
      const auto& t = corners(f);
      const bool all = region_.sphere || part.area.norm() > (X(t[1]) - X(t[0])).cross(X(t[2]) - X(t[0])).norm() / 4;
      if (all && in_sphere(f)) inside.push_back(f);
    });
    return inside;
  }

  /// Moves the corners of the circle's polygon along the edges that they were cut from, to another distance from the
  /// centre.
  void match_area(const std::vector<std::size_t>& inside) {
    std::vector<int> nodes;
    for (const auto& [node, along] : track_) nodes.push_back(node);
    double wanted = 0;
    for_each_part([&](std::size_t, const FacetPart& part) { wanted += part.area.norm(); });
    const double radius = region_.sphere->radius;
    double r0 = radius, a0 = area_at(nodes, r0, inside) - wanted, r1 = radius * std::sqrt(wanted / (a0 + wanted));
    for (int i = 0; i < 20 && std::abs(a0) > 1e-13 * wanted; ++i) {
      const double a1 = area_at(nodes, r1, inside) - wanted, r2 = a1 == a0 ? r1 : r1 - a1 * (r1 - r0) / (a1 - a0);
      r0 = std::exchange(r1, std::clamp(r2, 0.8 * radius, 1.2 * radius));
      a0 = a1;
    }
    mesh_.move(nodes, places(nodes, r0));
  }

  /// Of nodes on the sphere, at another distance from its centre.
  std::vector<Vec3> places(const std::vector<int>& nodes, double radius) const {
    std::vector<Vec3> at;
    for (const int n : nodes) {
      const Vec3 along = track_.at(n).normalized(), from = X(n) - region_.sphere->point;
      const double B = from.dot(along), discriminant = B * B - from.squaredNorm() + radius * radius;
      const double s = discriminant < 0 ? 0 : B > 0 ? -B + std::sqrt(discriminant) : -B - std::sqrt(discriminant);
      at.push_back(X(n) + s * along);
    }
    return at;
  }

  double area_at(const std::vector<int>& nodes, double radius, const std::vector<std::size_t>& inside) const {
    const std::vector<Vec3> to = places(nodes, radius);
    const auto at = [&](int n) -> const Vec3& {
      const auto found = std::lower_bound(nodes.begin(), nodes.end(), n);
      return found != nodes.end() && *found == n ? to[found - nodes.begin()] : X(n);
    };
    double area = 0;
    for (const std::size_t f : inside) {
      const auto& t = corners(f);
      area += (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).norm() / 2;
    }
    return area;
  }

  CutMesh& mesh_;
  const RuleRegion region_;
  const double facets_;        ///< across a patch
  std::map<int, Vec3> track_;  ///< of the nodes put on a border: the edge they were put on
};

}  // namespace

std::size_t imprint(const PatchRule& rule, int patch, double coarseness, CutMesh& mesh) {
  return Imprint(rule, coarseness, mesh).into(patch);
}

}  // namespace springproof
