#include "meshes/regions/solid_shape.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "meshes/mesher/mesher.h"
#include "meshes/volume.h"

namespace springproof {

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

}  // namespace springproof
