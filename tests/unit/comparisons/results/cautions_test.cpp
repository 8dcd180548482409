#include <gtest/gtest.h>

#include "comparisons/results/records.h"

namespace springproof::cautions_test {
namespace {

TEST(Cautions, NameTheModelsWhoseStressesWereAskedForAndAreNotKnown) {
  CaseResult result;
  for (const char* model : {"hybmss_avg", "emsm_random"}) {
    ModelChoice& choice = result.experiment.models.emplace_back();
    choice.name = choice.label = model;
  }
  result.experiment.measures = {"displacement_error", "stress_error"};
  Row row;
  row.model = "hybmss_avg";
  row.measure = "stress_error.von_mises";
  result.rows = {row};
  row.measure = "displacement_error";
  row.model = "emsm_random";
  result.rows.push_back(row);
  EXPECT_TRUE(cautions(result).empty());  // nor are the reference's
  result.references.emplace_back().measure = "stress_error.von_mises";
  ASSERT_EQ(cautions(result).size(), 1u);
  EXPECT_TRUE(cautions(result)[0].starts_with("no stress_error of emsm_random: ")) << cautions(result)[0];
  result.rows.pop_back();  // a run that failed
  EXPECT_TRUE(cautions(result).empty());
  result.rows.push_back(row);
  result.experiment.measures = {"displacement_error"};
  EXPECT_TRUE(cautions(result).empty());
}

}  // namespace
}  // namespace springproof::cautions_test
