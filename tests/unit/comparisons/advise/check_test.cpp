// Predictions against cases that were not used to make them (docs/advise.md); all of them: springproof advise --check.
#include "comparisons/advise/check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "comparisons/advise/measure.h"
#include "comparisons/run/case_run.h"
#include "comparisons/run/find_cases.h"
#include "comparisons/run/prepare.h"
#include "fem_reference/reference.h"

namespace springproof::check_test {
namespace {

const std::vector<Measurement>& held_out() {
  static const std::vector<Measurement> rows = read_measurements(advise_folder() / "held_out.csv").rows;
  return rows;
}

const std::vector<Measurement>& measured() {
  static const std::vector<Measurement> rows = read_measurements(advise_folder() / "measured.csv").rows;
  return rows;
}

// Small pilots, so that finer lattices are among them.
TEST(HeldOutErrors, NineOfTenArePredictedWithinAFactorOfOneAndAHalf) {
  std::vector<Judged> judged;
  for (const char* name : {"bar_askew", "golec_2019/bending"}) {
    const std::vector<Judged> some = judge_predictions(held_out(), measured(), name, {600, 12000});
    judged.insert(judged.end(), some.begin(), some.end());
  }
  const HitRate r = hit_rate(judged);
  EXPECT_GE(r.all, 75);
  EXPECT_GE(r.beyond, 20);
  EXPECT_GE(10 * r.hits, 9 * r.all) << r.hits << " of " << r.all;
  EXPECT_GE(10 * r.beyond_hits, 9 * r.beyond) << r.beyond_hits << " of " << r.beyond;
  EXPECT_GE(10 * r.table_hits, 9 * r.table) << "from the table: " << r.table_hits << " of " << r.table;
  EXPECT_GE(10 * r.inside, 9 * r.all) << "in the stated range: " << r.inside << " of " << r.all;
}

// The pilot's own reference finds the errors that were measured against finite elements.
TEST(MeasuredErrors, AreThoseOfThisProgram) {
  for (const auto& [load, nu] : {std::pair("bending", 0.25), std::pair("axial", 0.45)}) {
    std::vector<Measurement> rows;
    for (const Measurement& m : measured())
      if (m.load == load && m.body == "block" && m.strain == 0 && m.slenderness <= 4 &&
          same_poisson_ratio(m.poisson_ratio, nu) && m.cells_across <= 4 &&
          (rows.empty() || rows.front().slenderness == m.slenderness))
        rows.push_back(m);
    ASSERT_FALSE(rows.empty());
    const Experiment e = measured_case(rows.front());
    const Pilot pilot = solve_pilot(e, e.materials.front(), {"hybmss_avg", "hybmss", "emsm", "msm_18"}, {300, 12000});
    int compared = 0;
    for (const Measurement& m : rows)
      for (const PilotModel& model : pilot.models)
        if (model.label == m.model) {
          const double cells = std::pow(m.cells_across, 3) * m.slenderness;
          EXPECT_NEAR(predict(pilot, model, cells).error, m.error, 0.15 * m.error + 2 * m.uncertainty)
              << load << " " << m.model << " " << m.cells_across;
          ++compared;
        }
    EXPECT_GE(compared, 8);
  }
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
        if (row.measure == "displacement_error" && m.load == "block_standing" && m.model == row.model &&
            same_poisson_ratio(m.poisson_ratio, row.poisson_ratio) &&
            std::abs(std::pow(m.cells_across, 3) - cell_count(row.cells)) < 0.5) {
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
