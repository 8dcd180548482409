// Charts of curves over axes, as SVG and as one wide table.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace springproof {

/// Line and marker of a curve by what it shows: theory solid black, finite elements dashed, printed values open
/// markers, our results filled markers on a line of the curve's colour; a band is y - spread to y + spread, a shape a
/// closed outline.
enum class CurveStyle { theory, fem, printed, ours, ours_points, ours_bare, band, shape, shape_fem };

struct CurvePoint {
  double x = 0, y = 0;
  std::optional<double> spread = {};  ///< standard deviation of y
};

struct Curve {
  std::string label;
  CurveStyle style = CurveStyle::ours;
  std::vector<CurvePoint> points;
};

inline bool is_outline(const Curve& curve) {
  return curve.style == CurveStyle::shape || curve.style == CurveStyle::shape_fem;
}

/// Range of an axis that is not that of its curves.
struct AxisRange {
  std::optional<double> from = {}, to = {};
};

struct Chart {
  std::string title;  ///< above the axes; may be empty
  std::string x, y;   ///< labels of the axes with units
  std::vector<Curve> curves;
  AxisRange x_range = {}, y_range = {};
  std::vector<std::string> categories = {};  ///< names of x = 0, 1, ...; the curves are bars then
  bool equal_axes = false;                   ///< a metre is as long on both axes
};

/// Round numbers at equal distances that cover [from, to], about `count` of them.
std::vector<double> axis_ticks(double from, double to, int count);

/// The charts beside each other, with one legend, as a document of its own.
std::string charts_svg(const std::vector<Chart>& charts);

/// One line per x (of an outline: per point), one column per curve and, where it has them, one for its spread. Outlines
/// have a column of x each.
std::string charts_csv(const std::vector<Chart>& charts);

/// "<svg ...>", with its size in pixels, its font and a white ground.
std::string svg_head(double width, double height);

/// A text in pieces of at most so many bytes, broken at blanks.
std::vector<std::string> lines_of(const std::string& text, std::size_t longest);
/// A line of text; `attributes` such as `text-anchor="middle"`.
std::string svg_text(double x, double y, const std::string& text, const std::string& attributes = "");

}  // namespace springproof
