#include "comparisons/reproduce/bodies.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "comparisons/reproduce/chart.h"

namespace springproof {
namespace {

constexpr double panel_width = 250, panel_height = 216, panel_title = 40, bar_height = 58;

using Colour = std::array<double, 3>;

/// Viridis (van der Walt and Smith 2015) at eight places.
constexpr std::array<Colour, 8> viridis = {{{68, 1, 84},
                                            {70, 50, 127},
                                            {54, 92, 141},
                                            {39, 127, 142},
                                            {31, 161, 135},
                                            {74, 194, 109},
                                            {159, 218, 58},
                                            {253, 231, 37}}};

Colour colour_at(double share) {
  if (!std::isfinite(share)) return {160, 160, 160};
  const double place = std::clamp(share, 0.0, 1.0) * (viridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
  Colour out{};
  for (int i = 0; i < 3; ++i)
    out[i] = viridis[below][i] + (place - static_cast<double>(below)) * (viridis[below + 1][i] - viridis[below][i]);
  return out;
}

std::string hex(const Colour& colour, double light) {
  const auto part = [&](int i) { return static_cast<int>(std::lround(std::clamp(colour[i] * light, 0.0, 255.0))); };
  return fmt::format("#{:02x}{:02x}{:02x}", part(0), part(1), part(2));
}

struct Projection {
  Vec3 right, up, toward;

  explicit Projection(const BodyView& view) {
    toward = view.toward.normalized();
    right = view.up.cross(toward).normalized();
    up = toward.cross(right);
  }
  double x(const Vec3& p) const { return p.dot(right); }
  double y(const Vec3& p) const { return -p.dot(up); }
};

const std::vector<Vec3>& places_of(const BodyPanel& panel) {
  return panel.undeformed ? panel.shape->rest : panel.shape->displaced;
}

Eigen::AlignedBox2d limits_of(const BodyPanel& panel, const Projection& to) {
  Eigen::AlignedBox2d limits;
  for (const Vec3& p : places_of(panel))
    if (p.allFinite()) limits.extend(Eigen::Vector2d(to.x(p), to.y(p)));
  return limits;
}

std::string facets_svg(const BodyPanel& panel, const Projection& to, double scale, double x0, double y0,
                       double largest) {
  const std::vector<Vec3>& at = places_of(panel);
  std::vector<std::pair<double, std::string>> visible;  // by depth
  for (const auto& f : panel.shape->facets) {
    const Vec3 normal = (at[f[2]] - at[f[0]]).cross(at[f[3]] == at[f[2]] ? at[f[1]] - at[f[0]] : at[f[3]] - at[f[1]]);
    if (!normal.allFinite() || normal.norm() == 0) continue;
    const double facing = normal.normalized().dot(to.toward);
    std::string points;
    Vec3 middle = Vec3::Zero();
    double displacement = 0;
    for (int n : f) {
      points += fmt::format("{:.1f},{:.1f} ", x0 + scale * to.x(at[n]), y0 + scale * to.y(at[n]));
      middle += at[n] / 4;
      displacement += (panel.shape->displaced[n] - panel.shape->rest[n]).norm() / 4;
    }
    const Colour colour = panel.undeformed ? Colour{214, 214, 214} : colour_at(displacement / largest);
    visible.emplace_back(middle.dot(to.toward), fmt::format("<polygon points=\"{}\" fill=\"{}\"/>\n", points,
                                                            hex(colour, 0.68 + 0.32 * std::abs(facing))));
  }
  std::ranges::stable_sort(visible, [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string out = "<g stroke=\"#1d2430\" stroke-width=\"0.3\" stroke-linejoin=\"round\">\n";
  for (const auto& [depth, svg] : visible) out += svg;
  return out + "</g>\n";
}

double largest_displacement(const std::vector<BodyPanel>& panels) {
  double largest = 0;
  for (const BodyPanel& panel : panels)
    if (panel.shape && !panel.undeformed)
      for (std::size_t i = 0; i < panel.shape->rest.size(); ++i) {
        const double size = (panel.shape->displaced[i] - panel.shape->rest[i]).norm();
        if (std::isfinite(size)) largest = std::max(largest, size);
      }
  return largest > 0 ? largest : 1;
}

std::string colour_bar(double x, double y, double largest) {
  constexpr double width = 300;
  constexpr int steps = 60;
  std::string out;
  for (int i = 0; i < steps; ++i)
    out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"12\" fill=\"{}\"/>\n",
                       x + width * i / steps, y, width / steps + 0.6, hex(colour_at((i + 0.5) / steps), 1));
  out += svg_text(x, y + 28, "0", "text-anchor=\"middle\"");
  out += svg_text(x + width / 2, y + 28, "displacement", "text-anchor=\"middle\"");
  return out + svg_text(x + width, y + 28, fmt::format("{:.3g} m", largest), "text-anchor=\"middle\"");
}

/// The missing shape's reason, broken into lines.
std::string reason_svg(const std::string& reason, double x, double y) {
  std::string out;
  for (const std::string& line : lines_of(reason, 29)) {
    out += svg_text(x, y, line, "text-anchor=\"middle\" fill=\"#8f1d0a\"");
    y += 17;
  }
  return out;
}

}  // namespace

std::string bodies_svg(const std::vector<BodyPanel>& panels, int columns, const BodyView& view) {
  const Projection to(view);
  Eigen::Vector2d most = Eigen::Vector2d::Zero();
  for (const BodyPanel& panel : panels)
    if (panel.shape) most = most.cwiseMax(limits_of(panel, to).sizes());
  const double wide = most.x(), high = most.y();
  // Flat bodies need flat panels.
  const double room = panel_width - 24;
  const double tall = wide > 0 ? std::clamp(room * high / wide, 60.0, panel_height) : panel_height;
  const double scale = wide > 0 && high > 0 ? std::min(room / wide, tall / high) : 1;
  const double largest = largest_displacement(panels);
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  const double width = panel_width * columns, step = panel_title + tall + 16, height = step * rows + bar_height;
  std::string out = svg_head(width, height);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double x = panel_width * (static_cast<int>(i) % columns + 0.5), y = step * (static_cast<int>(i) / columns);
    out += svg_text(x, y + 18, panels[i].title, "text-anchor=\"middle\" font-weight=\"bold\"");
    out += svg_text(x, y + 34, panels[i].subtitle, "text-anchor=\"middle\"");
    if (!panels[i].shape) {
      out += reason_svg(panels[i].missing.empty() ? "no result" : panels[i].missing, x, y + panel_title + tall / 2);
      continue;
    }
    const Eigen::Vector2d centre = scale * limits_of(panels[i], to).center();
    out += facets_svg(panels[i], to, scale, x - centre.x(), y + panel_title + tall / 2 - centre.y() + 6, largest);
  }
  return out + colour_bar(width / 2 - 150, step * rows + 14, largest) + "</svg>\n";
}

std::vector<Vec3> layer_outline(const Shape& shape, int normal, const Vec3& point) {
  const int a = (normal + 1) % 3, b = (normal + 2) % 3;
  Eigen::AlignedBox3d box;
  for (const Vec3& p : shape.rest) box.extend(p);
  const double tolerance = 1e-4 * box.diagonal().norm();
  const Vec3 middle = box.center();
  std::vector<std::pair<double, Vec3>> around;
  for (std::size_t i = 0; i < shape.rest.size(); ++i)
    if (std::abs(shape.rest[i][normal] - point[normal]) < tolerance)
      around.emplace_back(std::atan2(shape.rest[i][b] - middle[b], shape.rest[i][a] - middle[a]), shape.displaced[i]);
  std::ranges::stable_sort(around, [](const auto& p, const auto& q) { return p.first < q.first; });
  std::vector<Vec3> outline;
  for (const auto& [angle, place] : around) outline.push_back(place);
  return outline;
}

}  // namespace springproof
