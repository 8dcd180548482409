// The [dynamics] table.
#include <gtest/gtest.h>

#include "problem/case_file/experiment.h"
#include "support/case_file.h"

namespace springproof {
namespace {

using test::message_of;

const std::string at_large_strain = std::string("kinematics = \"hencky\"\n") + test::small_case;

TEST(DynamicsTable, IsReadWithItsDefaults) {
  const Experiment e = parse_experiment(at_large_strain + "[dynamics]\nduration_s = 2\n", "case.toml");
  ASSERT_TRUE(e.dynamics);
  EXPECT_EQ(e.dynamics->duration, 2);
  EXPECT_FALSE(e.dynamics->time_step);
  EXPECT_EQ(e.dynamics->damping, 0);
  EXPECT_EQ(e.dynamics->ramp, 0);
}

TEST(DynamicsTable, AddsTheMotionOfEveryModel) {
  const std::string compare = "[compare]\nmodels = [\"hybmss\", { model = \"msm_18\", label = \"classic\" }]\n";
  const auto labels = [&](const std::string& more) {
    std::vector<std::string> out;
    for (const ModelChoice& m :
         parse_experiment(at_large_strain + compare + "[dynamics]\nduration_s = 2\n" + more, "case.toml").models)
      out.push_back(m.label + (m.in_motion ? "*" : ""));
    return out;
  };
  EXPECT_EQ(labels(""), (std::vector<std::string>{"hybmss", "hybmss in motion*", "classic", "classic in motion*"}));
  EXPECT_EQ(labels("equilibrium = false\n"), (std::vector<std::string>{"hybmss in motion*", "classic in motion*"}));
}

TEST(DynamicsTable, MistakesAreExplained) {
  const auto message = [](const std::string& lines) { return message_of(at_large_strain + "[dynamics]\n" + lines); };
  const auto says = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  says(message(""), "dynamics.duration_s: is missing");
  says(message("duration_s = 0"), "15:14: dynamics.duration_s: is 0 (allowed: a finite number > 0)");
  says(message("duration_s = inf"), "dynamics.duration_s");
  says(message("duration_s = 1\ntime_step_s = 0"), "dynamics.time_step_s: is 0");
  says(message("duration_s = 1\ntime_step_s = 2"), "dynamics.time_step_s: is 2");
  says(message("duration_s = 1\ndamping_1_s = -1"), "dynamics.damping_1_s: is -1");
  says(message("duration_s = 1\nramp_s = 2"),
       "dynamics.ramp_s: is 2 (allowed: a finite number >= 0, up to duration_s)");
  says(message("duration_s = 1\nsamples = 1"), "dynamics.samples: is 1 (allowed: an integer from 2 to 100000)");
  says(message("duration_s = 1\nframes = -1"), "dynamics.frames: is -1");
  says(message("duration_s = 1\nintegrator = \"midpoint\""),
       "dynamics.integrator: 'midpoint' is not known (allowed: explicit, energy_momentum, implicit_euler, bdf2, auto)");
  says(message("duration_s = 1\nstart = \"moving\""),
       "dynamics.start: 'moving' is not known (allowed: rest, equilibrium)");
  says(message("duration_s = 1\nstep_s = 1"), "dynamics.step_s: unknown key");
  says(message_of(std::string(test::small_case) + "[dynamics]\nduration_s = 1\n"),
       "dynamics: moves the models by their forces at large displacements");
}

}  // namespace
}  // namespace springproof
