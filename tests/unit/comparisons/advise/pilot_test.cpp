// What a pilot measures of a body in cut cells.
#include "comparisons/advise/pilot.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace springproof::pilot_test {
namespace {

TEST(Pilot, StepsOfCutCellsAreMeasuredOnTheBodyItself) {
  const Experiment e = parse_experiment(R"(
[body]
geo = "cylinder.geo"
size_m = [1, 1, 2]
voxels = [300]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
[[load]]
on = "bottom"
displacement_m = [0, 0, 0]
[[load]]
on = "top"
force_N = [0, 0, -1]
[compare]
models = ["hybmss_avg"]
)",
                                        "round.toml");
  const Pilot pilot = solve_pilot(e, e.materials.front(), {"hybmss_avg"}, {200, 1500});
  ASSERT_EQ(pilot.models.size(), 4U);
  ASSERT_TRUE(pilot.models[0].step);
  EXPECT_EQ(pilot.models[0].step->failure, "");
  EXPECT_GT(pilot.models[0].step->seconds_per_cell, 1e-9);
  EXPECT_GT(pilot.models[0].step->safe_step, 0);
  EXPECT_EQ(pilot.models[1].label, "hybmss_avg coarsened=true");
  EXPECT_NE(pilot.models[1].failure.find("not worth it"), std::string::npos) << "a bar without notches";
  EXPECT_EQ(pilot.models[2].label, "hybmss_avg cut=false");
  EXPECT_FALSE(pilot.models[2].step) << "whole cubes step as blocks do";
  const PilotModel& refined = pilot.models[3];
  EXPECT_EQ(refined.label, "hybmss_avg accuracy");
  ASSERT_GE(refined.cells.size(), 2U) << refined.failure;
  EXPECT_LT(refined.promised[1], refined.promised[0]);
  EXPECT_LT(refined.errors[1], refined.errors[0]);
  EXPECT_LT(refined.errors.back(), refined.promised.back());
  EXPECT_GT(refined.making, 0);
  EXPECT_TRUE(pilot.elements.empty()) << "there are none on a staircase";
}

/// Of a cube shortened by a tenth of a per cent, which its supports carry along.
Pilot of_carried_cube(double carried) {
  const Experiment e = parse_experiment(fmt::format(R"(
[body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [6, 6, 6]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.4
[[load]]
on = "z_min"
displacement_m = [{0}, 0, {0}]
[[load]]
on = "z_max"
displacement_m = [{0}, 0, {1}]
[compare]
models = ["hybmss_avg"]
)",
                                                    carried, carried - 0.001),
                                        "cube.toml");
  return solve_pilot(e, e.materials.front(), {"hybmss_avg", "msm_18"}, {300, 2000});
}

TEST(Pilot, ErrorsOfACarriedBodyAreRelativeToItsStrain) {
  const Pilot still = of_carried_cube(0), carried = of_carried_cube(0.5);
  ASSERT_EQ(still.models.size(), carried.models.size());
  // A linear displacement's root mean square is twice that of its distance from its mean; the sides bulge.
  const double ratio = carried.uncertainty / still.uncertainty;
  EXPECT_GT(ratio, 1.6);
  EXPECT_LT(ratio, 2);
  for (std::size_t m = 0; m < still.models.size(); ++m) {
    const PilotModel &at_rest = still.models[m], &moved = carried.models[m];
    ASSERT_FALSE(at_rest.errors.empty());
    EXPECT_NEAR(moved.errors.back() / at_rest.errors.back(), ratio, 0.02) << at_rest.label;
    EXPECT_NEAR(std::sqrt(moved.beyond.at(0.5) / at_rest.beyond.at(0.5)), ratio, 0.02) << at_rest.label;
  }
}

}  // namespace
}  // namespace springproof::pilot_test
