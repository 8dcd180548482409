// Finite elements in time as the reference of a motion.
#include "comparisons/models/motion_reference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "comparisons/run/case_run.h"
#include "comparisons/run/prepare.h"
#include "fem_reference/exchange/reference.h"

namespace springproof::motion_reference_test {
namespace {

TEST(MotionReference, InterpolatesCubicsExactly) {
  const auto f = [](double t) { return 1 + t * (2 - t * (3 - 0.5 * t)); };
  std::vector<double> times, values;
  for (int i = 0; i <= 6; ++i) {
    times.push_back(0.5 * i);
    values.push_back(f(times.back()));
  }
  for (const double t : {0.0, 0.1, 0.5, 1.3, 2.9, 3.0}) EXPECT_NEAR(at_time(times, values, t), f(t), 1e-12) << t;
}

TEST(MotionReference, StepsAreCorrectedToFourthOrder) {
  NodalVectors fine(1, 3), coarse(1, 3), truth(1, 3);
  const auto at = [](double dt) { return Vec3(1 + 4 * dt * dt, std::sin(1 - dt * dt), 2); };
  fine << at(0.01).transpose();
  coarse << at(0.02).transpose();
  truth << at(0).transpose();
  EXPECT_LT((fine + step_correction(fine, coarse) - truth).norm(), 1e-3 * (fine - truth).norm());
}

TEST(MotionReference, ErrorIsRelativeToTheReference) {
  HistoryRecord reference, model;
  for (int i = 0; i <= 40; ++i) {
    reference.time.push_back(0.05 * i);
    model.time.push_back(0.053 * i);  // other times, the last beyond the reference's
  }
  for (HistoryRecord* h : {&reference, &model}) {
    h->names = {"displacement.tip.x", "kinetic_energy"};
    h->values.resize(2);
    for (const double t : h->time) {
      h->values[0].push_back((h == &model ? 1.02 : 1.0) * std::sin(3 * t));
      h->values[1].push_back(h == &model ? 7 : 1);
    }
  }
  EXPECT_NEAR(history_error(model, reference), 0.02, 1e-4);
}

TEST(MotionReference, AWaveArrivesAsInFiniteElements) {
  if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  const Experiment e = parse_experiment(R"(kinematics = "hencky"
[body]
geo = "block.geo"
size_m = [0.4, 0.1, 0.1]
cells = [16, 4, 4]
[material]
youngs_modulus_Pa = 2.5e5
poisson_ratio = 0.3
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[[load]]
on = "x_max"
force_N = [-20, 0, 0]
[[probe]]
name = "inside"
at_m = [0.1, 0.05, 0.05]
[compare]
models = ["hybmss_avg"]
[reference]
in_time = true
[dynamics]
duration_s = 0.035
pulse_s = 0.012
equilibrium = false
samples = 36
frames = 0
)",
                                        "bar.toml");
  const Part part = run_part(prepare(e), 0, {});
  ASSERT_EQ(part.histories.size(), 2u) << part.runs.front().message;
  EXPECT_EQ(part.histories[0].model, "fem in motion");
  EXPECT_EQ(part.histories[0].values[0].size(), 73u);
  int found = 0;
  for (const Row& row : part.rows) {
    if (row.model == "hybmss_avg in motion") {
      EXPECT_NE(row.measure, "displacement_error") << "of the last instant from the equilibrium";
    }
    const bool arrival = row.measure == "motion.arrival";
    if (!arrival && row.measure != "motion_error") continue;
    ++found;
    ASSERT_TRUE(row.reference && row.reference_uncertainty && row.error) << row.measure;
    const double size = arrival ? *row.reference : 1;
    EXPECT_LT(*row.reference_uncertainty, (arrival ? 0.02 : 0.05) * size) << row.measure;
    EXPECT_LT(std::abs(*row.error), (arrival ? 0.02 : 0.1) * size) << row.measure;
  }
  EXPECT_EQ(found, 2);
}

}  // namespace
}  // namespace springproof::motion_reference_test
