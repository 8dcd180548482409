// [[external]]: displacements of another program as an entry among the models.
#include <gtest/gtest.h>

#include "problem/case_file/external.h"
#include "support/case_file.h"

namespace springproof::experiment_external_test {
namespace {

using test::message_of;
using test::small_case;

constexpr const char* external = R"(
[[external]]
name = "jolt"
file = "results/jolt.csv"
)";

TEST(ExternalTable, StandsBehindTheModels) {
  const Experiment e = parse_experiment(
      std::string(small_case) + external + "scale = 0.01\nup_axis = \"y\"\nreaction_N = { z_min = [0, 0, 5.5] }\n",
      "cases/case.toml");
  ASSERT_EQ(e.models.size(), 2u);
  EXPECT_FALSE(is_external(e.models[0]));
  const ModelChoice& jolt = e.models[1];
  EXPECT_TRUE(is_external(jolt));
  EXPECT_EQ(jolt.label, "jolt");
  EXPECT_EQ(jolt.file, "cases/results/jolt.csv");
  EXPECT_EQ(std::get<double>(jolt.options.at("poisson_ratio")), 0.3);
  EXPECT_EQ(std::get<double>(jolt.options.at("scale")), 0.01);
  EXPECT_EQ(std::get<std::string>(jolt.options.at("up_axis")), "y");
  EXPECT_EQ(std::get<double>(jolt.options.at("force.z_min.z")), 5.5);
  EXPECT_EQ(jolt.where.line, 14);
}

TEST(ExternalTable, GoesWithoutModels) {
  const Experiment e = parse_experiment(std::string(small_case) + "\n[compare]\nmodels = []\n" + external, "case.toml");
  ASSERT_EQ(e.models.size(), 1u);
  EXPECT_TRUE(is_external(e.models[0]));
}

TEST(ExternalTable, IsRefusedWithItsPlace) {
  const std::string whole = std::string(small_case) + external;
  const auto refused = [](const std::string& text, const std::string& words) {
    EXPECT_NE(message_of(text).find(words), std::string::npos) << message_of(text);
  };
  EXPECT_EQ(message_of(whole), "accepted");
  refused(whole + "poisson_ratio = 0.4\n", ":17:17: external.poisson_ratio: 0.4 is not in the case (allowed: 0.3)");
  refused(whole + "scale = 0\n", "external.scale: is 0");
  refused(whole + "up_axis = \"w\"\n", "external.up_axis: 'w' is not known");
  refused(whole + "reaction_N = [1, 2, 3]\n", "external.reaction_N: is no table of patches");
  refused(whole + "unit = \"mm\"\n", "external.unit: unknown key");
  refused(whole + external, "the label 'jolt' is taken");
  refused(std::string(small_case) + "\n[[external]]\nname = \"jolt\"\n", "external.file: is missing");
  std::string several = whole;
  several.replace(several.find("poisson_ratio = 0.3"), 19, "poisson_ratio = [0.3, 0.4]");
  refused(several, ":14:1: external.poisson_ratio: is missing, and the case has 2");
  EXPECT_EQ(message_of(several + "poisson_ratio = 0.4\n"), "accepted");
}

}  // namespace
}  // namespace springproof::experiment_external_test
