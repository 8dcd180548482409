// What the engines of the locked versions were measured to do (docs/measured/); skipped where one is missing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "comparisons/bench/engine_adapter.h"

namespace springproof::bench::engine_regressions_test {
namespace {

struct Measured {
  const char* set_up;
  double tip;      ///< relative error, nu = 1/4, 8x2x2 cells
  double stretch;  ///< energy over exact; 0: gives no forces
  double bending;
};

// Source: regression.  Within 2 points.
constexpr Measured measured[] = {
    {"MuJoCo, our export (5 tetrahedra)", -0.386, 1.100, 1.744},
    {"MuJoCo, full (6 tetrahedra)", -0.530, 1.100, 2.319},
    {"MuJoCo, trilinear", 0.578, 0.550, 0.628},
    {"MuJoCo, quadratic, cells twice as long", -0.352, 0.550, 1.528},
    {"Bullet, linear elasticity", -0.328, 1.000, 1.556},
    {"Bullet, neo-Hooke as entered", -0.038, 0.712, 1.097},
    {"Bullet, neo-Hooke converted", -0.328, 1.000, 1.556},
    {"Bullet, links, kLST 1", -0.965, 0, 0},
    {"Jolt, our export (msm_18)", -0.191, 0, 0},
};
constexpr double points = 0.02;

class Engines : public testing::TestWithParam<Measured> {};

TEST_P(Engines, DoWhatTheyWereMeasuredToDo) {
  const Measured& m = GetParam();
  const auto& all = engine_set_ups();
  const auto s = std::find_if(all.begin(), all.end(), [&](const EngineSetUp& e) { return e.name == m.set_up; });
  ASSERT_NE(s, all.end());
  if (const std::string missing = missing_for(s->adapter); !missing.empty()) GTEST_SKIP() << missing;
  EngineRuns runs({8, 2, 2});
  EngineTask task;
  task.iterations =
      s->steps.front().iterations > 0 ? s->steps.front().iterations : runs.exported_substeps(task.time_step);
  task.integrator = s->steps.front().integrator;
  task.forces = forces_of(BarLoad::gravity, runs.bar());
  task.damping = 2.4, task.duration = 9, task.free = 0.3;
  const EngineAnswer settled = runs.run(*s, 0.25, task);
  EXPECT_NEAR(measure_of(BarLoad::gravity, runs.bar(), settled.x - runs.bar().mesh.nodes) / 0.12064 - 1, m.tip, points)
      << settled.engine;
  if (m.stretch == 0) return;
  const std::vector<TestField> fields = test_fields(runs.bar(), bar_material(0.25));
  EngineTask forces;
  forces.pinned = false, forces.integrator = task.integrator;
  for (const TestField& field : fields) forces.fields.push_back(field.u);
  const EngineAnswer a = runs.run(*s, 0.25, forces);
  const auto share = [&](std::size_t i) { return -flat(a.forces[i]).dot(flat(fields[i].u)) / 2 / fields[i].energy; };
  EXPECT_NEAR(share(0), m.stretch, points) << fields[0].name;
  EXPECT_NEAR(share(3), m.bending, points) << fields[3].name;
}

INSTANTIATE_TEST_SUITE_P(All, Engines, testing::ValuesIn(measured), [](const auto& p) {
  std::string name;
  for (const char c : std::string(p.param.set_up))
    if (std::isalnum(static_cast<unsigned char>(c))) name += c;
  return name;
});

}  // namespace
}  // namespace springproof::bench::engine_regressions_test
