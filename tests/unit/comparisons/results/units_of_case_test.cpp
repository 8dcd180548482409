// Results of a case in millimetres are in millimetres, N and MPa.
#include <gtest/gtest.h>

#include "comparisons/results/records.h"

namespace springproof::units_of_case_test {
namespace {

TEST(UnitsOfCase, ResultsAreGivenInThem) {
  CaseResult result;
  result.experiment.units = Units::mm;
  const auto row = [](const std::string& unit, double value) {
    Row r;
    r.unit = unit;
    r.value = value;
    r.error = value;
    return r;
  };
  result.rows = {row("m", 0.002), row("N", 3), row("N m", 0.5), row("Pa", 1e6), row("1", 0.04)};
  give_in_units_of_case(result);
  const std::vector<std::string> units = {"mm", "N", "N mm", "MPa", "1"};
  const std::vector<double> values = {2, 3, 500, 1, 0.04};
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(result.rows[i].unit, units[i]);
    EXPECT_DOUBLE_EQ(result.rows[i].value, values[i]);
    EXPECT_DOUBLE_EQ(*result.rows[i].error, values[i]);
    EXPECT_FALSE(result.rows[i].reference);
  }
  EXPECT_EQ(describe(Pressure{"x_max", 2000}, Kinematics::linear, Units::mm), "x_max: pressed by 0.002 MPa");
  EXPECT_EQ(describe(PointForce{Vec3(0.06, 0, 0.01), Vec3(0, 1, 0)}, Kinematics::linear, Units::mm),
            "point (60, 0, 10) mm: loaded by a force of (0, 1, 0) N");
}

TEST(UnitsOfCase, WordsHaveThem) {
  EXPECT_EQ(text(Vec3(0.1, 0.02, -0.0123456), Units::mm, "m", 3), "(100, 20, -12.3) mm");
  EXPECT_EQ(text(0.25, Units::m), "0.25 m");
}

}  // namespace
}  // namespace springproof::units_of_case_test
