#include "comparisons/reproduce/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "problem/files/encoding.h"

namespace springproof {
namespace {

constexpr double axes_height = 330, margin_left = 78, margin_right = 16, margin_top = 30, margin_bottom = 58;
constexpr double legend_width = 270, legend_line = 20;

/// Colours that remain distinct for colour-blind readers (Okabe and Ito).
constexpr std::array curve_colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                      "#e69f00", "#56b4e9", "#7a5195", "#6b6b00"};
constexpr int marker_count = 4;

struct Extent {
  double from = std::numeric_limits<double>::infinity(), to = -from;

  void include(double value) {
    if (!std::isfinite(value)) return;
    from = std::min(from, value);
    to = std::max(to, value);
  }
};

/// What maps values to the pixels of one chart.
struct Frame {
  double left = 0, top = margin_top, width = 0, height = axes_height;
  Extent x, y;

  double px(double value) const { return left + width * (value - x.from) / (x.to - x.from); }
  double py(double value) const { return top + height * (y.to - value) / (y.to - y.from); }
};

Extent extent_of(const Chart& chart, bool of_x) {
  Extent range;
  for (const Curve& curve : chart.curves)
    for (const CurvePoint& p : curve.points) {
      const double spread = of_x ? 0 : p.spread.value_or(0);
      range.include((of_x ? p.x : p.y) - spread);
      range.include((of_x ? p.x : p.y) + spread);
    }
  if (!of_x && !chart.categories.empty()) range.include(0);
  if (of_x && !chart.categories.empty()) range = {-0.5, static_cast<double>(chart.categories.size()) - 0.5};
  if (!(range.from <= range.to)) range = {0, 1};
  const bool wide = range.to - range.from > 1e-12 * std::max(std::abs(range.from), std::abs(range.to));
  const double margin = wide ? 0.04 * (range.to - range.from) : std::max(0.1 * std::abs(range.to), 1e-12);
  if (!(of_x && !chart.categories.empty())) {
    range.from -= chart.categories.empty() ? margin : 0;
    range.to += margin;
  }
  const AxisRange& fixed = of_x ? chart.x_range : chart.y_range;
  return {fixed.from.value_or(range.from), fixed.to.value_or(range.to)};
}

/// Widens the shorter axis until a unit has one length on both.
void make_equal(Frame& frame) {
  const double per_pixel =
      std::max((frame.x.to - frame.x.from) / frame.width, (frame.y.to - frame.y.from) / frame.height);
  for (const auto& [range, pixels] : {std::pair{&frame.x, frame.width}, std::pair{&frame.y, frame.height}}) {
    const double middle = (range->from + range->to) / 2;
    *range = {middle - per_pixel * pixels / 2, middle + per_pixel * pixels / 2};
  }
}

std::string tick_text(double value, double step) {
  return fmt::format("{:g}", std::abs(value) < 1e-9 * step ? 0.0 : std::round(value / step * 1e6) * step / 1e6);
}

std::string axis_svg(const Chart& chart, const Frame& f) {
  std::string out;
  const std::vector<double> xs = axis_ticks(f.x.from, f.x.to, static_cast<int>(f.width / 75));
  const std::vector<double> ys = axis_ticks(f.y.from, f.y.to, 7);
  const auto step = [](const std::vector<double>& ticks) { return ticks.size() > 1 ? ticks[1] - ticks[0] : 1; };
  const auto grid = [&](double x0, double y0, double x1, double y1) {
    out += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#dddddd\"/>\n", x0, y0,
                       x1, y1);
  };
  if (chart.categories.empty())
    for (double x : xs) {
      grid(f.px(x), f.top, f.px(x), f.top + f.height);
      out += svg_text(f.px(x), f.top + f.height + 18, tick_text(x, step(xs)), "text-anchor=\"middle\"");
    }
  for (std::size_t i = 0; i < chart.categories.size(); ++i)
    out += svg_text(f.px(static_cast<double>(i)), f.top + f.height + 18, chart.categories[i], "text-anchor=\"middle\"");
  for (double y : ys) {
    grid(f.left, f.py(y), f.left + f.width, f.py(y));
    out += svg_text(f.left - 8, f.py(y) + 4.5, tick_text(y, step(ys)), "text-anchor=\"end\"");
  }
  out += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" stroke=\"#333333\"/>\n", f.left,
      f.top, f.width, f.height);
  out += svg_text(f.left + f.width / 2, f.top + f.height + 42, chart.x, "text-anchor=\"middle\"");
  const double middle = f.top + f.height / 2, side = f.left - 58;
  out += svg_text(side, middle, chart.y,
                  fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 {:.1f} {:.1f})\"", side, middle));
  if (!chart.title.empty())
    out += svg_text(f.left + f.width / 2, f.top - 11, chart.title, "text-anchor=\"middle\" font-weight=\"bold\"");
  return out;
}

/// A marker of one of four forms around a point.
std::string marker_svg(double x, double y, int form, const std::string& paint) {
  constexpr double r = 4.2;
  switch (form % marker_count) {
    case 0:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n", x, y, r, paint);
    case 1:
      return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>\n", x - 3.7, y - 3.7,
                         7.4, 7.4, paint);
    case 2:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l5 8.6h-10z\" {}/>\n", x, y - 5.4, paint);
    default:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l5.2 5.2l-5.2 5.2l-5.2 -5.2z\" {}/>\n", x, y - 5.2, paint);
  }
}

/// How curves of a style are drawn; {} is their colour.
struct Look {
  const char *line = "", *marker = "";
  bool ours = false;  ///< has a colour of its own
};
constexpr const char *theory_line = "stroke=\"#000000\" stroke-width=\"1.6\"",
                     *fem_line = "stroke=\"#000000\" stroke-width=\"1.6\" stroke-dasharray=\"7 4\"",
                     *own_line = "stroke=\"{}\" stroke-width=\"1.8\"", *own_marker = "fill=\"{}\"",
                     *printed_marker = "fill=\"#ffffff\" stroke=\"#000000\" stroke-width=\"1.4\"";

Look look_of(CurveStyle style) {
  static const std::map<CurveStyle, Look> looks = {{CurveStyle::theory, {theory_line}},
                                                   {CurveStyle::fem, {fem_line}},
                                                   {CurveStyle::shape_fem, {fem_line}},
                                                   {CurveStyle::printed, {"", printed_marker}},
                                                   {CurveStyle::ours, {own_line, own_marker, true}},
                                                   {CurveStyle::ours_points, {"", own_marker, true}},
                                                   {CurveStyle::ours_bare, {own_line, "", true}},
                                                   {CurveStyle::shape, {own_line, "", true}},
                                                   {CurveStyle::band, {}}};
  return looks.at(style);
}

std::string line_svg(const Curve& curve, const Frame& f, const std::string& paint) {
  std::string path;
  bool down = false;
  for (const CurvePoint& p : curve.points) {
    const bool here = std::isfinite(p.x) && std::isfinite(p.y);
    if (here) path += fmt::format("{}{:.1f} {:.1f}", down ? "L" : "M", f.px(p.x), f.py(p.y));
    down = here;
  }
  if (path.empty()) return "";
  return fmt::format("<path d=\"{}{}\" fill=\"none\" {}/>\n", path, is_outline(curve) ? "z" : "", paint);
}

std::string band_svg(const Curve& curve, const Frame& f) {
  std::string points;
  for (const CurvePoint& p : curve.points)
    points += fmt::format("{:.1f},{:.1f} ", f.px(p.x), f.py(p.y + p.spread.value_or(0)));
  for (auto p = curve.points.rbegin(); p != curve.points.rend(); ++p)
    points += fmt::format("{:.1f},{:.1f} ", f.px(p->x), f.py(p->y - p->spread.value_or(0)));
  return fmt::format("<polygon points=\"{}\" fill=\"#999999\" fill-opacity=\"0.25\"/>\n", points);
}

std::string spread_svg(const CurvePoint& p, const Frame& f, double x, const std::string& colour) {
  if (!p.spread) return "";
  const double up = f.py(p.y + *p.spread), down = f.py(p.y - *p.spread);
  return fmt::format(
      "<path d=\"M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {1:.1f}h8M{3:.1f} {2:.1f}h8\" stroke=\"{4}\" fill=\"none\"/>\n", x,
      up, down, x - 4, colour);
}

/// A curve's colour, line and marker; those of one label look alike in all charts.
struct Paint {
  std::string colour, line, marker;
  int form;
};

Paint paint_of(const std::vector<Chart>& charts, const Curve& curve) {
  std::vector<std::string> known;
  for (const Chart& chart : charts)
    for (const Curve& c : chart.curves)
      if (look_of(c.style).ours && std::ranges::find(known, c.label) == known.end()) known.push_back(c.label);
  const auto number = std::ranges::find(known, curve.label) - known.begin();
  const std::string colour = curve_colours[static_cast<std::size_t>(number) % curve_colours.size()];
  const Look look = look_of(curve.style);
  return {colour, fmt::format(fmt::runtime(look.line), colour), fmt::format(fmt::runtime(look.marker), colour),
          static_cast<int>(number)};
}

std::string curve_svg(const std::vector<Chart>& charts, const Curve& curve, const Frame& f) {
  if (curve.style == CurveStyle::band) return band_svg(curve, f);
  const auto [colour, line, marker, form] = paint_of(charts, curve);
  std::string out = line.empty() ? "" : line_svg(curve, f, line);
  for (const CurvePoint& p : curve.points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
    out += spread_svg(p, f, f.px(p.x), colour);
    if (!marker.empty()) out += marker_svg(f.px(p.x), f.py(p.y), form, marker);
  }
  return out;
}

std::string bars_svg(const std::vector<Chart>& charts, const Chart& chart, const Frame& f) {
  std::string out;
  const double slot = f.width / static_cast<double>(chart.categories.size()),
               bar = 0.8 * slot / static_cast<double>(chart.curves.size());
  for (std::size_t c = 0; c < chart.curves.size(); ++c)
    for (const CurvePoint& p : chart.curves[c].points) {
      if (!std::isfinite(p.y)) continue;
      const double x = f.px(p.x) - 0.4 * slot + bar * static_cast<double>(c);
      const std::string colour = paint_of(charts, chart.curves[c]).colour;
      out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n", x,
                         f.py(p.y), bar - 1, f.py(0) - f.py(p.y), colour) +
             spread_svg(p, f, x + bar / 2, "#333333");
    }
  return out;
}

std::string sample_svg(const std::vector<Chart>& charts, const Curve& curve, bool bars, double x, double y) {
  const auto [colour, line, marker, form] = paint_of(charts, curve);
  if (bars || curve.style == CurveStyle::band)
    return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"26\" height=\"11\" fill=\"{}\" fill-opacity=\"{}\"/>\n",
                       x, y - 10, bars ? colour : "#999999", bars ? 1 : 0.25);
  std::string out;
  if (!line.empty()) out += fmt::format("<path d=\"M{:.1f} {:.1f}h28\" fill=\"none\" {}/>\n", x, y - 4.5, line);
  if (!marker.empty()) out += marker_svg(x + 14, y - 4.5, form, marker);
  return out;
}

std::string legend_svg(const std::vector<Chart>& charts, double x, double& y) {
  std::string out;
  std::set<std::string> shown;
  for (const Chart& chart : charts)
    for (const Curve& curve : chart.curves) {
      if (curve.label.empty() || !shown.insert(curve.label).second) continue;
      out += sample_svg(charts, curve, !chart.categories.empty(), x, y);
      for (const std::string& line : lines_of(curve.label, 29)) {
        out += svg_text(x + 36, y, line);
        y += legend_line - 3;
      }
      y += 5;
    }
  return out;
}

}  // namespace

std::vector<double> axis_ticks(double from, double to, int count) {
  if (!(to > from)) return {from};
  const double rough = (to - from) / std::max(count, 2), power = std::pow(10, std::floor(std::log10(rough)));
  const double lead = rough / power, step = power * (lead > 5 ? 10 : lead > 2 ? 5 : lead > 1 ? 2 : 1);
  std::vector<double> ticks;
  for (double k = std::ceil(from / step - 1e-9); k * step <= to + 1e-9 * step; ++k) ticks.push_back(k * step);
  return ticks;
}

std::vector<std::string> lines_of(const std::string& text, std::size_t longest) {
  std::vector<std::string> lines = {""};
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > longest)
      lines.push_back(word);
    else
      lines.back() += (lines.back().empty() ? "" : " ") + word;
    at = end + 1;
  }
  return lines;
}

std::string svg_head(double width, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" font-size=\"13\" fill=\"#111111\">\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n",
      width, height);
}

std::string svg_text(double x, double y, const std::string& text, const std::string& attributes) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, attributes, xml_escaped(text));
}

std::string charts_svg(const std::vector<Chart>& charts) {
  const double axes_width = charts.size() == 1 ? 500 : 300;
  const double step = margin_left + axes_width + margin_right;
  const double right = step * static_cast<double>(charts.size());
  double legend_end = margin_top + 12;
  const std::string legend = legend_svg(charts, right + 4, legend_end);
  std::string body;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    Frame frame{step * static_cast<double>(i) + margin_left,
                margin_top,
                axes_width,
                axes_height,
                extent_of(charts[i], true),
                extent_of(charts[i], false)};
    if (charts[i].equal_axes) make_equal(frame);
    body += axis_svg(charts[i], frame);
    body += fmt::format(
        "<clipPath id=\"axes{0}\"><rect x=\"{1:.1f}\" y=\"{2:.1f}\" width=\"{3:.1f}\" "
        "height=\"{4:.1f}\"/></clipPath>\n<g clip-path=\"url(#axes{0})\">\n",
        i, frame.left, frame.top, frame.width, frame.height);
    if (charts[i].categories.empty())
      for (const Curve& curve : charts[i].curves) body += curve_svg(charts, curve, frame);
    else
      body += bars_svg(charts, charts[i], frame);
    body += "</g>\n";
  }
  const double height = std::max(margin_top + axes_height + margin_bottom, legend_end + 10);
  return svg_head(right + legend_width, height) + body + legend + "</svg>\n";
}

}  // namespace springproof
