// Predictions against cases that were not used to make them (docs/advise.md); all of them: springproof advise --check.

#include <gtest/gtest.h>

#include "comparisons/advise/measure.h"
#include "comparisons/run/case_run.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/find_cases.h"
#include "fem_reference/exchange/reference.h"

namespace springproof::check_test {
namespace {

const std::vector<Measurement>& held_out() {
  static const std::vector<Measurement> rows = read_measurements(advise_folder() / "held_out.csv");
  return rows;
}

// Small pilots, so that finer lattices are among them.
TEST(HeldOutErrors, NineOfTenArePredictedWithinAFactorOfOneAndAHalf) {
  std::vector<Judged> judged;
  for (const char* name : {"bar_askew", "golec_2019/bending"}) {
    const std::vector<Judged> some = judge_predictions(held_out(), name, {600, 12000});
    judged.insert(judged.end(), some.begin(), some.end());
  }
  const HitRate r = hit_rate(judged);
  EXPECT_GE(r.all, 75);
  EXPECT_GE(r.beyond, 20);
  EXPECT_GE(10 * r.hits, 9 * r.all) << r.hits << " of " << r.all;
  EXPECT_GE(10 * r.beyond_hits, 9 * r.beyond) << r.beyond_hits << " of " << r.beyond;
  EXPECT_GE(10 * r.inside, 9 * r.all) << "in the stated range: " << r.inside << " of " << r.all;
}

// Linear and quadratic elements are piloted as the models are.
TEST(HeldOutErrors, OfFiniteElementsArePredictedToo) {
  if (!fem::available()) GTEST_SKIP() << "springproof-fem is not here";
  std::vector<Judged> elements;
  for (const Judged& j : judge_predictions(held_out(), "bar_askew", {600, 12000}))
    if (j.truth.model.starts_with("fem_")) elements.push_back(j);
  const HitRate r = hit_rate(elements);
  EXPECT_GE(r.all, 15);
  EXPECT_GE(r.beyond, 5);
  EXPECT_GE(10 * r.hits, 9 * r.all) << r.hits << " of " << r.all;
  EXPECT_GE(10 * r.inside, 9 * r.all) << "in the stated range: " << r.inside << " of " << r.all;
}

// One truth is computed again: the file cannot go stale.
TEST(HeldOutErrors, AreThoseOfThisProgram) {
  if (!fem::available()) GTEST_SKIP() << "springproof-fem is not here";
  for (Experiment e : held_out_cases()) {
    if (case_name(e.file) != "block_standing") continue;
    e.materials.resize(1);
    const PreparedCase prepared = prepare(e);
    const Part part = run_part(prepared, 0, {});
    int compared = 0;
    for (const Row& row : part.rows)
      for (const Measurement& m : held_out())
        if (row.measure == "displacement_error" && m.case_name == "block_standing" && m.model == row.model &&
            same_poisson_ratio(m.poisson_ratio, row.poisson_ratio) && m.cells == cell_count(row.cells)) {
          EXPECT_NEAR(row.value, m.error, 1e-3 * m.error + 1e-6) << m.model;
          ++compared;
        }
    EXPECT_EQ(compared, 10);
    return;
  }
  FAIL() << "no such case";
}

}  // namespace
}  // namespace springproof::check_test
