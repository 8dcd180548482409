// What a pilot measures of a body in cut cells.
#include "comparisons/advise/pilot.h"

#include <gtest/gtest.h>

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
  ASSERT_EQ(pilot.models.size(), 2U);
  ASSERT_TRUE(pilot.models[0].step);
  EXPECT_EQ(pilot.models[0].step->failure, "");
  EXPECT_GT(pilot.models[0].step->seconds_per_cell, 1e-9);
  EXPECT_GT(pilot.models[0].step->safe_step, 0);
  EXPECT_EQ(pilot.models[1].label, "hybmss_avg cut=false");
  EXPECT_FALSE(pilot.models[1].step) << "whole cubes step as blocks do";
  EXPECT_TRUE(pilot.elements.empty()) << "there are none on a staircase";
}

}  // namespace
}  // namespace springproof::pilot_test
