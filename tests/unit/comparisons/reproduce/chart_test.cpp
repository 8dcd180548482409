#include "comparisons/reproduce/chart.h"

#include <gtest/gtest.h>

namespace springproof::chart_test {
namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

Chart sample_chart() {
  Chart chart{"", "x [m]", "y [m]", {}};
  chart.curves = {{"printed", CurveStyle::printed, {{0, 0}, {1, 1}}},
                  {"ours", CurveStyle::ours, {{0, 0.1, 0.05}, {0.5, 0.6}, {1, std::nan("")}}},
                  {"FEM < theory", CurveStyle::fem, {{0, 0}, {1, 1.2}}}};
  return chart;
}

TEST(AxisTicks, AreRoundAndCoverTheRange) {
  EXPECT_EQ(axis_ticks(0, 1, 5), (std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1}));
  EXPECT_EQ(axis_ticks(-3, 3, 3), (std::vector<double>{-2, 0, 2}));
  EXPECT_EQ(axis_ticks(2, 2, 5), (std::vector<double>{2}));
}

TEST(ChartSvg, HasLinesMarkersAndEscapedNames) {
  const std::string svg = charts_svg({sample_chart()});
  EXPECT_TRUE(svg.starts_with("<svg xmlns="));
  EXPECT_EQ(count_of(svg, "<svg"), count_of(svg, "</svg>"));
  EXPECT_EQ(count_of(svg, "stroke-dasharray"), 2u) << "the finite elements: curve and legend";
  EXPECT_EQ(count_of(svg, "fill=\"#ffffff\" stroke=\"#000000\""), 3u) << "printed: two open markers and the legend's";
  EXPECT_EQ(count_of(svg, "fill=\"#0072b2\"/>"), 3u) << "ours: two filled markers and the legend's";
  EXPECT_NE(svg.find("FEM &lt; theory"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos) << "a point that is no number is left out";
}

TEST(ChartSvg, MapsValuesToPixels) {
  Chart chart{"", "x", "y", {{"line", CurveStyle::theory, {{0, 0}, {10, 1}}}}};
  chart.x_range = {0, 10};
  chart.y_range = {0, 1};
  EXPECT_NE(charts_svg({chart}).find("<path d=\"M78.0 360.0L578.0 30.0\""), std::string::npos);
}

TEST(ChartCsv, HasAColumnPerCurveAndAnEmptyFieldWhereACurveHasNoPoint) {
  EXPECT_EQ(charts_csv({sample_chart()}),
            "x,printed,ours,ours_spread,FEM_theory\n"
            "0,0,0.1,0.05,0\n"
            "0.5,,0.6,,\n"
            "1,1,,,1.2\n");
}

TEST(ChartCsv, OutlinesHaveAnXOfTheirOwn) {
  Chart chart{
      "a", "x", "y", {{"s", CurveStyle::shape, {{0, 0}, {1, 0}, {1, 1}}}, {"fem", CurveStyle::shape_fem, {{0, 2}}}}};
  EXPECT_EQ(charts_csv({chart}), "s_x,s_y,fem_x,fem_y\n0,0,0,2\n1,0,,\n1,1,,\n");
}

TEST(ChartSvg, BarsStandOnZero) {
  Chart chart{"", "component", "deviation [%]", {{"a", CurveStyle::ours, {{0, 5}, {1, 10}}}}};
  chart.categories = {"11", "22"};
  const std::string svg = charts_svg({chart});
  EXPECT_NE(svg.find(">11</text>"), std::string::npos);
  EXPECT_EQ(count_of(svg, "fill=\"#0072b2\""), 3u) << "two bars and the legend";
}

}  // namespace
}  // namespace springproof::chart_test
