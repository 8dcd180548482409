// Deformed bodies as vector graphics: orthographic views of their surfaces, coloured by displacement.
#pragma once

#include <string>
#include <vector>

#include "comparisons/reproduce/paper_results.h"

namespace springproof {

/// Where the viewer stands: looks against `toward`, with `up` upwards on the picture.
struct BodyView {
  Vec3 toward = {0.55, -1, 0.45}, up = {0, 0, 1};
};

struct BodyPanel {
  std::string title, subtitle;
  std::optional<Shape> shape;  ///< none: the panel says why
  std::string missing = "";    ///< why there is no shape
  bool undeformed = false;     ///< drawn at rest, without colour
};

/// Panels in rows of `columns`, all in one scale and with one range of colours (displacement in m, from zero).
std::string bodies_svg(const std::vector<BodyPanel>& panels, int columns, const BodyView& view);

/// Outline of the layer of surface nodes in the plane through `point` normal to coordinate axis `normal`: deformed
/// places, in order around the layer's middle.  Empty: no nodes lie in that plane.
std::vector<Vec3> layer_outline(const Shape& shape, int normal, const Vec3& point);

}  // namespace springproof
