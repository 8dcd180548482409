// [fracture]: what is read, what is refused.
#include <gtest/gtest.h>

#include "problem/case_file/experiment.h"
#include "support/case_file.h"

namespace springproof::experiment_fracture_test {
namespace {

using test::message_of;

const std::string drying_case = R"([body]
geo = "cylinder.geo"
size_m = [2, 2, 0.3]
voxel_edge_m = 0.1

[material]
youngs_modulus_Pa = 1
poisson_ratio = 0.25

[[load]]
on = "bottom"
displacement_m = [0, 0, 0]

[fracture]
shrinkage = 0.1
steps = 50
depth_m = 0.2
threshold = 0.05
scatter = 0.03
apart = 3
seed = 4
seeds = 10

[compare]
models = ["msm_centred"]
)";

std::string edited(const std::string& old, const std::string& with) {
  std::string text = drying_case;
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), with);
}

TEST(FractureCase, IsRead) {
  const Experiment e = parse_experiment(drying_case, "case.toml");
  ASSERT_TRUE(e.fracture);
  EXPECT_EQ(e.fracture->shrinkage, 0.1);
  EXPECT_EQ(e.fracture->steps, 50);
  EXPECT_EQ(e.fracture->depth, 0.2);
  EXPECT_EQ(e.fracture->threshold, 0.05);
  EXPECT_EQ(e.fracture->scatter, 0.03);
  EXPECT_EQ(e.fracture->apart, 3);
  EXPECT_EQ(e.fracture->seed, 4u);
  EXPECT_EQ(e.fracture->seeds, 10);
  EXPECT_EQ(e.measures, std::vector<std::string>{"fracture"});
  EXPECT_TRUE(e.reference.elements.empty());
  EXPECT_TRUE(e.elements.empty());
}

TEST(FractureCase, NeedsShrinkageAndThresholdAlone) {
  const Experiment e = parse_experiment(
      edited("steps = 50\ndepth_m = 0.2\nthreshold = 0.05\nscatter = 0.03\napart = 3\nseed = 4\nseeds = 10\n",
             "threshold = 0.05\n"),
      "case.toml");
  EXPECT_EQ(e.fracture->steps, 100);
  EXPECT_GT(e.fracture->depth, 1e300);
  EXPECT_EQ(e.fracture->scatter, 0);
  EXPECT_EQ(e.fracture->seeds, 1);
}

TEST(FractureCase, RefusesWhatIsOutOfRange) {
  const auto expect = [](const std::string& old, const std::string& with, const std::string& place,
                         const std::string& says) {
    const std::string message = message_of(edited(old, with));
    EXPECT_TRUE(message.starts_with("case.toml:" + place)) << message;
    EXPECT_NE(message.find(says), std::string::npos) << message;
  };
  expect("threshold = 0.05", "threshold = 0", "18:13: fracture.threshold: is 0", "> 0, up to 1");
  expect("threshold = 0.05", "threshold = -1", "18:13: fracture.threshold: is -1", "> 0, up to 1");
  expect("scatter = 0.03", "scatter = -0.1", "19:11: fracture.scatter: is -0.1", "from 0 to 0.5");
  expect("shrinkage = 0.1", "shrinkage = 0.6", "15:13: fracture.shrinkage: is 0.6", "from 0 to 0.5");
  expect("steps = 50", "steps = 0", "16:9: fracture.steps: is 0", "from 1 to 100000");
  expect("steps = 50", "steps = 2.5", "16:9: fracture.steps: is 2.5", "whole number");
  expect("steps = 50", "steps = 1", "15:13: fracture.shrinkage: is 0.1 in each of 1 steps",
         "shrinkage / steps up to the threshold, 0.05");
  expect("depth_m = 0.2", "depth_m = 0", "17:11: fracture.depth_m: is 0", "> 0");
  expect("apart = 3", "apart = -3", "20:9: fracture.apart: is -3", ">= 0");
  expect("seeds = 10", "seeds = 0", "22:9: fracture.seeds: is 0", "from 1 to 1000");

  expect("threshold = 0.05\n", "", "14:1: fracture.threshold: is missing", "> 0");
  expect("[0, 0, 0]", "[0, 0, 0.1]", "10:1: load: cannot act on a body that dries", "displacement_m = [0, 0, 0]");
  expect("[0, 0, 0]", "[0, 0, \"free\"]", "10:1: load: cannot act on a body that dries", "displacement_m = [0, 0, 0]");
  expect("displacement_m = [0, 0, 0]", "force_N = [0, 0, 1]", "10:1: load: cannot act", "displacement_m = [0, 0, 0]");
  expect("[compare]\n", "[compare]\nmeasures = [\"volume_change\"]\n", "25:13: ", "not measured where a body dries");
  expect("[compare]\n", "[compare]\nelements = [\"q1\"]\n", "25:12: compare.elements: does not go with [fracture]", "");
  expect("[compare]\n", "[reference]\nedge_m = 0.1\n[compare]\n", "24:1: reference: does not go with [fracture]", "");
  EXPECT_NE(message_of("kinematics = \"hencky\"\n" + drying_case).find("fracture: does not go with kinematics"),
            std::string::npos);
}

TEST(FractureCase, IsNeededByItsMeasure) {
  std::string text = drying_case;
  text.erase(text.find("[fracture]"), text.find("[compare]") - text.find("[fracture]"));
  EXPECT_NE(message_of(text + "measures = [\"fracture\"]\n").find("'fracture' needs a body that dries"),
            std::string::npos);
}

}  // namespace
}  // namespace springproof::experiment_fracture_test
