#include <gtest/gtest.h>

#include "comparisons/results/records.h"

namespace springproof::cautions_test {
namespace {

TEST(Cautions, NameTheModelsWhoseStressesWereAskedForAndAreNotKnown) {
  CaseResult result;
  result.experiment.models = {{.name = "hybmss_avg", .label = "hybmss_avg"},
                              {.name = "emsm_random", .label = "emsm_random"}};
  result.experiment.measures = {"displacement_error", "stress_error"};
  Row row;
  row.model = "hybmss_avg";
  row.measure = "stress_error.von_mises";
  result.rows = {row};
  ASSERT_EQ(cautions(result).size(), 1u);
  EXPECT_TRUE(cautions(result)[0].starts_with("no stress_error of emsm_random: ")) << cautions(result)[0];
  result.experiment.measures = {"displacement_error"};
  EXPECT_TRUE(cautions(result).empty());
}

}  // namespace
}  // namespace springproof::cautions_test
