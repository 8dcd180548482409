// The [material.relaxation] table.
#include <gtest/gtest.h>

#include "support/case_file.h"

namespace springproof::experiment_relaxation_test {
namespace {

using test::message_of;

std::string with_branches(const std::string& branches) {
  return std::string("kinematics = \"hencky\"\n") + test::small_case + "[material.relaxation]\nbranches = " + branches +
         "\n";
}

TEST(RelaxationTable, HasTheBranchesInTheirOrder) {
  const Experiment e = parse_experiment(
      with_branches("[{ share = 0.116, time_s = 0.27 }, { share = 0.057, time_s = 2.6 }]"), "case.toml");
  ASSERT_EQ(e.relaxation.branches.size(), 2u);
  EXPECT_EQ(e.relaxation.branches[0].share, 0.116);
  EXPECT_EQ(e.relaxation.branches[1].time, 2.6);
  EXPECT_FALSE(parse_experiment(test::small_case, "case.toml").relaxation.acts());
}

TEST(RelaxationTable, MistakesAreExplained) {
  const auto says = [](const std::string& said, const std::string& part) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
  };
  const auto message = [](const std::string& branches) { return message_of(with_branches(branches)); };
  says(message("[{ share = -0.1, time_s = 1 }]"), "share: is -0.1 (allowed: a number from 1e-6 to 1000)");
  says(message("[{ share = 0, time_s = 1 }]"), "share: is 0");
  says(message("[{ share = 1e-17, time_s = 1 }]"), "share: is 1e-17");
  says(message("[{ share = 0.1, time_s = 0 }]"), "time_s: is 0 (allowed: a finite number > 0)");
  says(message("[{ share = 0.1, time_s = -1 }]"), "time_s: is -1");
  says(message("[{ share = 0.1 }]"), "time_s: is missing");
  says(message("[{ share = 0.1, time_s = 1, of = \"volume\" }]"), "of: unknown key");
  says(message("[{ share = 0.1, time_s = 1 }, { share = 0.2, time_s = 1 }]"),
       "time_s: 1 s is that of another branch (allowed: one branch of each time, with the sum of their shares)");
  says(message("[]"), "a list of up to 8");
  says(message("3"), "a list of up to 8");
  std::string many = "[";
  for (int i = 1; i <= 9; ++i) many += "{ share = 0.1, time_s = " + std::to_string(i) + " },";
  says(message(many + "]"), "has 9 branches");
  says(message_of(std::string(test::small_case) +
                  "[material.relaxation]\nbranches = [{ share = 0.1, time_s = 1 }]\n[fracture]\n"),
       "material.relaxation: stands beside [fracture], whose springs do not relax (allowed: one of the two)");
}

}  // namespace
}  // namespace springproof::experiment_relaxation_test
