#include "meshes/regions/solid_shape.h"

#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "meshes/facets.h"
#include "meshes/mesher/mesher.h"

namespace springproof {
namespace {

constexpr double on_side = 1e-6;       // barycentric: a point so near to a side is on it
constexpr double sharp_below = 0.766;  // cosine of 40 degrees

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Weights of the corners at a point of a triangle.
Vec3 barycentric(const std::array<Vec3, 3>& x, const Vec3& point) {
  const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
  Vec3 weights;
  for (int i = 0; i < 3; ++i)
    weights[i] = (x[(i + 2) % 3] - x[(i + 1) % 3]).cross(point - x[(i + 1) % 3]).dot(normal) / normal.squaredNorm();
  return weights;
}

}  // namespace

SolidShape shape_of(const PatchRule::Box& box) {
  const Vec3 size = box.high - box.low;
  SolidShape shape{{}, size.minCoeff(), size.prod()};
  for (int axis = 0; axis < 3; ++axis) {
    shape.borders.push_back({{box.low, Vec3::Unit(axis), 0}});
    shape.borders.push_back({{box.high, -Vec3::Unit(axis), 0}});
  }
  return shape;
}

SolidShape shape_of(const PatchRule::Near& ball) {
  return {{{{ball.point, Vec3::Zero(), ball.radius}}},
          2 * ball.radius,
          4 * std::numbers::pi / 3 * std::pow(ball.radius, 3)};
}

SolidShape shape_of(const PatchRule::Beyond& side) {
  return {{{{side.point, side.normal, 0}}}, std::numeric_limits<double>::infinity(), 0};
}

SolidShape shape_of(const Surface& facets) {
  const Box box = bounding_box(facets);
  const double inside = springproof::volume(facets);
  return {{{{}, std::make_shared<const Enclosed>(facets)}},
          std::min((box.high - box.low).minCoeff(), 6 * inside / area(facets)),
          inside};
}

SolidShape shape_of(const EnclosedPlace& place) { return shape_of(closed_surface(place.file, place.scale).facets); }

Enclosed::Enclosed(const Surface& surface)
    : surface_(surface),
      box_(bounding_box(surface)),
      of_points_(surface.points.size(), Vec3::Zero()),
      beyond_(surface.triangles.size()),
      tree_(surface.points, surface.triangles) {
  std::map<std::array<int, 2>, std::array<int, 2>> sides;  // from, to: facet, side
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    const auto& t = surface.triangles[f];
    const auto X = [&](int i) -> const Vec3& { return surface.points[t[i % 3]]; };
    of_facets_.push_back((X(1) - X(0)).cross(X(2) - X(0)).normalized());
    for (int i = 0; i < 3; ++i) {
      of_points_[t[i]] += angle_between(X(i + 1) - X(i), X(i + 2) - X(i)) * of_facets_.back();
      sides[{t[i], t[(i + 1) % 3]}] = {static_cast<int>(f), i};
    }
  }
  for (const auto& [ends, side] : sides) {
    const auto other = sides.find({ends[1], ends[0]});
    const int beyond = other == sides.end() ? side[0] : other->second[0];
    beyond_[side[0]][side[1]] = beyond;
    if (ends[0] < ends[1] && of_facets_[side[0]].dot(of_facets_[beyond]) < sharp_below)
      sharp_.push_back({surface.points[ends[0]], surface.points[ends[1]]});
  }
}

/// Of the side or corner on which the point lies the mean: which side of the surface a point lies on follows from the
/// nearest point of it (Baerentzen and Aanaes 2005).
Vec3 Enclosed::normal_at(std::size_t facet, const Vec3& point) const {
  const auto& t = surface_.triangles[facet];
  const Vec3 weights = barycentric({surface_.points[t[0]], surface_.points[t[1]], surface_.points[t[2]]}, point);
  for (int i = 0; i < 3; ++i)
    if (weights[i] > 1 - on_side) return of_points_[t[i]];
  for (int i = 0; i < 3; ++i)
    if (weights[(i + 2) % 3] < on_side) return of_facets_[facet] + of_facets_[beyond_[facet][i]];
  return of_facets_[facet];
}

double Enclosed::depth(const Vec3& point) const {
  const FacetTree::Nearest nearest = tree_.nearest(point);
  return std::copysign(nearest.distance, normal_at(nearest.facet, nearest.point).dot(nearest.point - point));
}

std::optional<Vec3> Enclosed::on_sharp_edge(const Vec3& point, double within) const {
  std::optional<Vec3> best;
  for (const auto& edge : sharp_)
    if (const Vec3 at = closest_point(point, edge[0], edge[1]); (at - point).norm() <= within) {
      within = (at - point).norm();
      best = at;
    }
  return best;
}

}  // namespace springproof
