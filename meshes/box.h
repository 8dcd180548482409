// Boxes with edges along the axes.
#pragma once

#include <limits>

#include "problem/vector.h"

namespace springproof {

/// Box with edges along the axes.
struct Box {
  Vec3 low;   ///< lowest corner
  Vec3 high;  ///< highest corner
};

/// A box with nothing in it.
inline Box empty_box() {
  const Vec3 far = Vec3::Constant(std::numeric_limits<double>::infinity());
  return {far, -far};
}
inline void add_to(Box& box, const Vec3& point) {
  box.low = box.low.cwiseMin(point);
  box.high = box.high.cwiseMax(point);
}
template <class Points>
Box box_of(const Points& points) {
  Box box = empty_box();
  for (const Vec3& x : points) add_to(box, x);
  return box;
}

}  // namespace springproof
