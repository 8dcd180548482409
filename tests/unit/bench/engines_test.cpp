#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "comparisons/bench/engine_motion.h"
#include "comparisons/bench/engine_ours.h"

namespace springproof::bench::engines_test {
namespace {

using Json = nlohmann::json;

const EngineBar& bar() {
  static const EngineBar b = engine_bar({8, 2, 2});
  return b;
}

TEST(EngineBar, LoadsHaveTheirResultants) {
  const NodalVectors weight = forces_of(BarLoad::gravity, bar()), torque = forces_of(BarLoad::torque, bar()),
                     pressure = forces_of(BarLoad::pressure, bar());
  EXPECT_NEAR(weight.col(2).sum(), -4000 * bar_gravity, 1e-9);
  EXPECT_NEAR(pressure.col(0).sum(), -2000, 1e-9);
  EXPECT_LT(torque.colwise().sum().norm(), 1e-9);
  const auto& X = bar().mesh.nodes;
  EXPECT_NEAR((X.col(1).cwiseProduct(torque.col(2)) - X.col(2).cwiseProduct(torque.col(1))).sum(), 300, 1e-9);
}

TEST(EngineBar, MeasuresAreTheMotionsOfTheEndFace) {
  const auto& X = bar().mesh.nodes;
  NodalVectors u = NodalVectors::Zero(X.rows(), 3);
  u.col(2).setConstant(-0.1);
  EXPECT_NEAR(measure_of(BarLoad::gravity, bar(), u), 0.1, 1e-12);
  EXPECT_NEAR(measure_of(BarLoad::torque, bar(), u), 0, 1e-12);
  EXPECT_NEAR(measure_of(BarLoad::pressure, bar(), u), 0, 1e-12);
  u.col(1) = -0.01 * X.col(2), u.col(2) = 0.01 * X.col(1);
  EXPECT_NEAR(measure_of(BarLoad::torque, bar(), u), 0.01, 1e-12);
  EXPECT_NEAR(measure_of(BarLoad::pressure, bar(), 1e-3 * X), 3e-3, 1e-12);
}

/// Lattices are exact in constant strain, and the hourglass correction makes them so in strains linear in one cell.
TEST(EngineBar, EnergiesOfTestFieldsAreThoseOfTheSolid) {
  for (const double nu : {0.0, 0.25, 0.45}) {
    EngineTask task;
    const std::vector<TestField> fields = test_fields(bar(), bar_material(nu));
    for (const TestField& field : fields) task.fields.push_back(field.u);
    const EngineAnswer a = run_ours(model_of_bar("hybmss_bt", bar(), nu), bar(), task);
    ASSERT_EQ(fields.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(-flat(a.forces[i]).dot(flat(fields[i].u)) / 2 / fields[i].energy, 1, 1e-3) << fields[i].name << nu;
  }
}

/// A vibration in the direction (0, 1, 1) with some of a second, faster one across it.
std::vector<EngineSample> vibration(double frequency, double damping) {
  std::vector<EngineSample> samples;
  const double w = 2 * std::numbers::pi * frequency;
  for (int i = 0; i <= 1200; ++i) {
    const double t = i / 60.0, decay = std::exp(-damping * w * t);
    const double u = decay * std::sin(w * t), v = decay * w * std::cos(w * t);
    const double across = 0.1 * std::sin(1.3 * w * t);
    samples.push_back({t, v * v, Vec3(4, 0.5 + u + across, 0.5 + u - across), Vec3(0, 0, 5 - t / 10)});
  }
  return samples;
}

TEST(EngineMotion, FrequencyAndDampingOfADecayingVibrationAreFound) {
  const Vec3 d(0, std::sqrt(0.5), std::sqrt(0.5));
  for (const double damping : {0.0, 0.005, 0.03}) {
    const auto found = vibration_of(vibration(0.31, damping), d);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->frequency, 0.31, 1e-3 * 0.31);
    EXPECT_NEAR(found->damping, damping, 2e-4);
  }
  EXPECT_FALSE(vibration_of(vibration(0.1, 0), d)) << "two periods tell nothing";
  EXPECT_NEAR(spin_kept(vibration(0.31, 0)), 0.6, 1e-12);
}

Json answer_at_rest(const EngineTask& task) {
  Json positions = Json::array(), samples = Json::array();
  for (Eigen::Index n = 0; n < bar().mesh.nodes.rows(); ++n) {
    const auto x = bar().mesh.nodes.row(n);
    positions.push_back({x[0], x[1], x[2]});
  }
  for (long i = 0; i <= task.steps(); ++i) samples.push_back({double(i) / 60, 0, 4, 0.5, 0.5, 0, 0, 0});
  return {
      {"engine", "none"}, {"steps", task.steps()}, {"seconds", 0.1}, {"positions_m", positions}, {"samples", samples}};
}

TEST(EngineAnswers, WhatWasNotAskedForIsNotBelieved) {
  EngineTask task;
  task.duration = 0.1;
  const Json good = answer_at_rest(task);
  EXPECT_FALSE(read_answer(good, task, bar()).burst);
  const auto spoilt = [&](const char* pointer, const Json& value) {
    Json bad = good;
    bad[Json::json_pointer(pointer)] = value;
    return bad;
  };
  EXPECT_THROW(read_answer(spoilt("/steps", 5), task, bar()), std::runtime_error);
  EXPECT_THROW(read_answer(spoilt("/samples/0/2", 3.9), task, bar()), std::runtime_error) << "another body";
  EXPECT_THROW(read_answer(spoilt("/positions_m/0/2", 0.01), task, bar()), std::runtime_error) << "a held node moved";
  EXPECT_THROW(read_answer(spoilt("/positions_m/3", Json::array({1, 2})), task, bar()), std::runtime_error);
  EXPECT_THROW(read_answer(spoilt("/positions_m", Json::array()), task, bar()), std::runtime_error);
  EXPECT_THROW(read_answer(spoilt("/samples/1", Json::array({1})), task, bar()), std::runtime_error);
  EXPECT_THROW(read_answer(spoilt("/seconds", "fast"), task, bar()), std::exception);
  EXPECT_TRUE(read_answer(spoilt("/positions_m/8/2", nullptr), task, bar()).burst)
      << "no number: a result, not an error";
  EXPECT_TRUE(read_answer(spoilt("/positions_m/8/2", 1e6), task, bar()).burst);
}

TEST(EngineRuler, SpringsSteppedByAnAdapterEndWhereOurSolverSays) {
  if (const std::string missing = missing_for("springs"); !missing.empty()) GTEST_SKIP() << missing;
  EngineTask task;
  task.iterations = 2;
  task.forces = forces_of(BarLoad::gravity, bar());
  task.damping = 3.6, task.duration = 10;
  EngineRuns runs({8, 2, 2});
  const EngineSetUp springs{"springs", "springs", "edges", EngineSetUp::File::edges, false, false, true, {}};
  const EngineAnswer a = runs.run(springs, 0.25, task);
  const double known = finite_tip(model_of_bar("msm_18", bar(), 0.25), bar());
  EXPECT_NEAR(measure_of(BarLoad::gravity, bar(), a.x - bar().mesh.nodes) / known, 1, 1e-6);
  const EngineAnswer ours = run_ours(model_of_bar("msm_18", bar(), 0.25), bar(), task);
  EXPECT_NEAR(measure_of(BarLoad::gravity, bar(), ours.x - bar().mesh.nodes) / known, 1, 1e-6);
}

}  // namespace
}  // namespace springproof::bench::engines_test
