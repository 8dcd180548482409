// What users see of deal.II's messages.
#include "fem_reference/exchange/plain_words.h"

#include <gtest/gtest.h>

namespace springproof::plain_words_test {
namespace {

TEST(PlainWords, AreWhatAnExceptionHasToSay) {
  const std::string message =
      "\n--------------------------------------------------------\nAn error occurred in line <1101> of file "
      "<./include/deal.II/lac/solver_cg.h> in function\n"
      "    void dealii::SolverCG<VectorType>::solve(...)\nThe violated condition was: \n    conv == "
      "SolverControl::success\n"
      "Additional information: \n    Iterative method reported convergence failure in step 1000. The residual\n    in "
      "the last step was 1.2.\n"
      "\nStacktrace:\n-----------\n#0  springproof-fem: "
      "main\n--------------------------------------------------------\n";
  EXPECT_EQ(
      fem::plain_words(message),
      "deal.II: Iterative method reported convergence failure in step 1000. The residual in the last step was 1.2.");
  EXPECT_EQ(fem::plain_words("An error occurred in line <1> of file <x>\nThe violated condition was: a < b\n"),
            "deal.II: a condition does not hold: a < b");
  EXPECT_EQ(fem::plain_words("case.toml: --cells: 3 - 4 are\nwrong \n"), "case.toml: --cells: 3 - 4 are wrong");
  EXPECT_EQ(fem::plain_words("\x1b[1;31mno \x1b[38;5;9mroom\x1b[0m"), "no room");
  EXPECT_EQ(fem::plain_words(""), "");
}

}  // namespace
}  // namespace springproof::plain_words_test
