#include "meshes/patches/rule_region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "meshes/facets.h"

namespace springproof {
namespace {

constexpr double region_tolerance = 1e-9;

using Polygon = std::vector<Vec3>;
using Triangle = std::array<int, 3>;

/// The side of the plane with depth >= 0.
Polygon clipped(const Polygon& polygon, const Border& plane, double slack) {
  Polygon out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = plane.depth(a), db = plane.depth(b);
    if (da >= -slack) out.push_back(a);
    if ((da > slack && db < -slack) || (da < -slack && db > slack)) out.push_back(a + da / (da - db) * (b - a));
  }
  return out;
}

/// Twice the area vector, by corners relative to the first: exact for a triangle's own.
Vec3 doubled_area(const Polygon& p) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 2; i < p.size(); ++i) sum += (p[i - 1] - p[0]).cross(p[i] - p[0]);
  return sum;
}

/// Area and first moment in a plane.
struct Moments {
  double area = 0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();

  void add(double part, const Eigen::Vector2d& at) {
    area += part;
    first += part * at;
  }
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

void add_sector(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius, Moments& sum) {
  const Eigen::Vector2d u = a.normalized(), v = b.normalized();
  sum.area += radius * radius / 2 * std::atan2(cross(u, v), u.dot(v));
  sum.first += std::pow(radius, 3) / 3 * Eigen::Vector2d(v.y() - u.y(), u.x() - v.x());
}

/// What the edge a-b adds to the part of a polygon in the disc about 0: the triangle to 0 where it runs within, else
/// the sector.
void add_edge(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius, Moments& sum) {
  const Eigen::Vector2d d = b - a;
  const double A = d.squaredNorm(), B = a.dot(d), discriminant = B * B - A * (a.squaredNorm() - radius * radius);
  if (A == 0) return;
  const double root = std::sqrt(std::max(discriminant, 0.0)), t1 = std::clamp((-B - root) / A, 0.0, 1.0),
               t2 = std::clamp((-B + root) / A, 0.0, 1.0);
  if (discriminant <= 0 || t1 >= t2) return add_sector(a, b, radius, sum);
  const Eigen::Vector2d p = a + t1 * d, q = a + t2 * d;
  if (t1 > 0) add_sector(a, p, radius, sum);
  sum.add(cross(p, q) / 2, (p + q) / 3);
  if (t2 < 1) add_sector(q, b, radius, sum);
}

Moments moments_of(const std::vector<Eigen::Vector2d>& polygon) {
  Moments sum;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum.add(cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]) / 2,
            (polygon[0] + polygon[i - 1] + polygon[i]) / 3);
  return sum;
}

/// The part of a plane polygon with unit normal n within a sphere, or all of it.
Moments within(const std::vector<Eigen::Vector2d>& polygon, double radius_squared) {
  if (std::all_of(polygon.begin(), polygon.end(), [&](const auto& x) { return x.squaredNorm() <= radius_squared; }))
    return moments_of(polygon);
  Moments sum;
  for (std::size_t i = 0; i < polygon.size() && radius_squared > 0; ++i)
    add_edge(polygon[i], polygon[(i + 1) % polygon.size()], std::sqrt(radius_squared), sum);
  return sum;
}

bool faces(const PatchRule::Facing& facing, const Vec3& n) {
  const double angle = std::atan2(n.cross(facing.direction).norm(), n.dot(facing.direction)) * 180 / std::numbers::pi;
  return angle <= facing.within_deg * (1 + region_tolerance);
}

FacetPart part_of(const RuleRegion& region, Polygon polygon) {
  const Vec3 n = doubled_area(polygon).normalized();
  if (region.facing && !faces(*region.facing, n)) return {};
  double around = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) around += (polygon[i] - polygon[(i + 1) % polygon.size()]).norm();
  for (const Border& plane : region.planes) polygon = clipped(polygon, plane, region.slack);
  if (polygon.size() < 3) return {};
  const Vec3 centre = region.sphere ? region.sphere->point : polygon[0], e1 = n.unitOrthogonal(), e2 = n.cross(e1);
  const double height = n.dot(polygon[0] - centre);
  const Vec3 origin = centre + height * n;
  std::vector<Eigen::Vector2d> flat;
  for (const Vec3& x : polygon) flat.emplace_back(e1.dot(x - origin), e2.dot(x - origin));
  const Moments m =
      region.sphere ? within(flat, std::pow(region.sphere->radius, 2) - height * height) : moments_of(flat);
  if (!(m.area > region.slack * around)) return {};
  const Eigen::Vector2d at = m.first / m.area;
  return {m.area * n, origin + at.x() * e1 + at.y() * e2, std::move(polygon)};
}

/// Which facets are connected with those at the sphere's centre, by edges that reach into it.
std::vector<char> piece_around(const Border& sphere, const Surface& s, double slack) {
  const Vec3& centre = sphere.point;
  const auto X = [&](int n) -> const Vec3& { return s.points[n]; };
  const auto distance = [&](const Vec3& nearest) { return (nearest - centre).norm(); };
  std::vector<std::pair<std::pair<int, int>, int>> edges;  // and a facet that has it
  std::vector<char> at_centre(s.triangles.size(), 0);
  for (std::size_t f = 0; f < at_centre.size(); ++f) {
    const Triangle& t = s.triangles[f];
    for (int c = 0; c < 3; ++c)
      if (const auto [a, b] = edge_of(t, c); distance(closest_point(centre, X(a), X(b))) < sphere.radius)
        edges.emplace_back(edge_of(t, c), static_cast<int>(f));
    at_centre[f] = distance(closest_point(centre, X(t[0]), X(t[1]), X(t[2]))) <= slack;
  }
  UnitedNumbers pieces(at_centre.size());
  unite_by_key(std::move(edges), pieces);
  std::vector<char> wanted(at_centre.size(), 0), piece = wanted;
  for (std::size_t f = 0; f < piece.size(); ++f) wanted[pieces.of(static_cast<int>(f))] |= at_centre[f];
  for (std::size_t f = 0; f < piece.size(); ++f) piece[f] = wanted[pieces.of(static_cast<int>(f))];
  return piece;
}

Vec3 nearest_point(const Vec3& p, const Surface& s) {
  Vec3 best = Vec3::Constant(std::numeric_limits<double>::infinity());
  for (const Triangle& t : s.triangles) {
    const Vec3 x = closest_point(p, s.points[t[0]], s.points[t[1]], s.points[t[2]]);
    if ((x - p).squaredNorm() < (best - p).squaredNorm()) best = x;
  }
  return best;
}

/// Sum of the facets' areas along `outwards` that face it within the angle and lie wholly above the height.
double area_above(double height, const PatchRule::Facing& facing, const Surface& s) {
  double sum = 0;
  for (const Triangle& t : s.triangles) {
    const Vec3 doubled = doubled_area({s.points[t[0]], s.points[t[1]], s.points[t[2]]});
    const bool above =
        std::all_of(t.begin(), t.end(), [&](int n) { return facing.direction.dot(s.points[n]) >= height; });
    if (above && faces(facing, doubled)) sum += facing.direction.dot(doubled) / 2;
  }
  return sum;
}

}  // namespace

PatchRule settled(PatchRule rule, const Surface& surface) {
  if (!rule.side) return rule;
  constexpr double flat_depth = 1e-3, round_depth = 0.05, flat_share = 0.01, flat_deg = 10;
  const int side = static_cast<int>(*rule.side), axis = side / 2;
  const Box box = bounding_box(surface);
  const Vec3 size = box.high - box.low, outwards = side % 2 ? Vec3::Unit(axis) : Vec3(-Vec3::Unit(axis)),
             extreme = side % 2 ? box.high : box.low;
  const auto at = [&](double depth) -> Vec3 { return extreme - depth * size[axis] * outwards; };
  const PatchRule::Facing facing{outwards, flat_deg};
  const bool flat = area_above(outwards.dot(at(flat_depth)), facing, surface) >= flat_share * size.prod() / size[axis];
  rule.beyond = {at(flat ? flat_depth : round_depth), outwards};
  if (flat) rule.facing = facing;
  rule.side.reset();
  return rule;
}

RuleRegion rule_region(const PatchRule& given, const Surface& surface) {
  const PatchRule rule = settled(given, surface);
  RuleRegion region;
  for (int axis = 0; rule.box && axis < 3; ++axis) {
    region.planes.push_back({rule.box->low, Vec3::Unit(axis)});
    region.planes.push_back({rule.box->high, -Vec3::Unit(axis)});
  }
  if (rule.beyond) region.planes.push_back({rule.beyond->point, rule.beyond->normal});
  if (rule.near) region.sphere = Border{nearest_point(rule.near->point, surface), Vec3::Zero(), rule.near->radius};
  region.facing = rule.facing;
  const Box box = bounding_box(surface);
  region.slack = region_tolerance * (box.high - box.low).norm();
  return region;
}

std::vector<FacetPart> parts_within(const RuleRegion& region, const Surface& surface) {
  std::vector<char> in(surface.triangles.size(), 1);
  if (region.sphere) in = piece_around(*region.sphere, surface, region.slack);
  std::vector<FacetPart> parts(in.size());
  for (std::size_t f = 0; f < parts.size(); ++f) {
    const Triangle& t = surface.triangles[f];
    if (in[f]) parts[f] = part_of(region, {surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]});
  }
  return parts;
}

std::vector<FacetPart> parts_of(const PatchRule& rule, const Surface& surface) {
  std::vector<FacetPart> parts = parts_within(rule_region(rule, surface), surface);
  std::erase_if(parts, [](const FacetPart& p) { return p.area.isZero(0); });
  return parts;
}

std::vector<FacetPart> parts_of(const PatchRule& rule, const Mesh& mesh) { return parts_of(rule, outside_of(mesh)); }

}  // namespace springproof
