// [[external]]: displacements of another program as an entry among the models.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "problem/case_file/experiment.h"
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

std::string two_ratios() {
  std::string text = small_case;
  return text.replace(text.find("poisson_ratio = 0.3"), 19, "poisson_ratio = [0.3, 0.4]");
}

/// "jolt 0.3 a.csv; jolt 0.4 b.csv": the entries behind the first model.
std::string entries_of(const std::string& tables) {
  std::string words;
  for (const ModelChoice& m : parse_experiment(two_ratios() + tables, "case.toml").models)
    if (is_external(m))
      words += fmt::format("{}{} {:g} {}", words.empty() ? "" : "; ", m.label,
                           std::get<double>(m.options.at("poisson_ratio")), m.file.string());
  return words;
}

TEST(ExternalTable, HasOneLabelForTheFilesOfSeveralPoissonRatios) {
  const std::string in_a_list = R"(
[[external]]
name = "jolt"
scale = 0.01
files = [{ poisson_ratio = 0.3, file = "a.csv" }, { poisson_ratio = 0.4, file = "b.csv", reaction_N = { z_min = [0, 0, 2] } }]
)";
  const std::string again = R"(
[[external]]
name = "jolt"
file = "a.csv"
poisson_ratio = 0.3
[[external]]
name = "jolt"
file = "b.csv"
poisson_ratio = 0.4
)";
  EXPECT_EQ(entries_of(in_a_list), "jolt 0.3 a.csv; jolt 0.4 b.csv");
  EXPECT_EQ(entries_of(again), entries_of(in_a_list));
  const Experiment e = parse_experiment(two_ratios() + in_a_list, "case.toml");
  EXPECT_EQ(std::get<double>(e.models[2].options.at("scale")), 0.01);
  EXPECT_EQ(std::get<double>(e.models[2].options.at("force.z_min.z")), 2);
  EXPECT_FALSE(e.models[1].options.contains("force.z_min.z"));
}

TEST(ExternalTable, IsASpringModelUnlessItSaysOtherwise) {
  const std::string table = std::string(small_case) + external;
  EXPECT_TRUE(is_own_model(parse_experiment(table, "case.toml").models[1]));
  EXPECT_FALSE(is_own_model(parse_experiment(table + "springs = false\n", "case.toml").models[1]));
  EXPECT_FALSE(is_own_model(parse_experiment(table, "case.toml").models[0]));  // of the table, not the user's own
  const std::string both = two_ratios() + external + "poisson_ratio = 0.3\n" + external + "poisson_ratio = 0.4\n";
  EXPECT_EQ(message_of(both), "accepted");
  EXPECT_NE(message_of(both + "springs = false\n").find("the label 'jolt' is of springs at one Poisson's ratio"),
            std::string::npos);
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
  refused(whole + external, ":18:1: external.name: the label 'jolt' has a file at nu = 0.3 already");
  refused(whole + "[compare]\nmodels = [{ model = \"hybmss\", label = \"jolt\" }]\n", "the label 'jolt' is taken");
  refused(whole + "springs = 1\n", "external.springs: is");
  refused(whole + "files = [{ file = \"a.csv\" }]\n",
          "external.file: stands beside files (allowed: in the rows of files)");
  refused(std::string(small_case) + "\n[[external]]\nname = \"jolt\"\n", "external.file: is missing");
  std::string several = whole;
  several.replace(several.find("poisson_ratio = 0.3"), 19, "poisson_ratio = [0.3, 0.4]");
  refused(several, ":14:1: external.poisson_ratio: is missing, and the case has 2");
  EXPECT_EQ(message_of(several + "poisson_ratio = 0.4\n"), "accepted");
}

}  // namespace
}  // namespace springproof::experiment_external_test
