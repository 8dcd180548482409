// The [dynamics] table.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "problem/case_file/experiment.h"
#include "support/case_file.h"

namespace springproof::experiment_dynamics_test {
namespace {

using test::message_of;

const std::string at_large_strain = std::string("kinematics = \"hencky\"\n") + test::small_case;

TEST(DynamicsTable, IsReadWithItsDefaults) {
  const Experiment e = parse_experiment(at_large_strain + "[dynamics]\nduration_s = 2\n", "case.toml");
  ASSERT_TRUE(e.dynamics);
  EXPECT_EQ(e.dynamics->duration, 2);
  EXPECT_FALSE(e.dynamics->time_step);
  EXPECT_EQ(e.dynamics->damping, 0);
  EXPECT_EQ(e.dynamics->course.ramp, 0);
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

TEST(DynamicsTable, WithoutEquilibriaHasNoFiniteElementsAtRest) {
  const auto elements = [&](const std::string& lines) {
    return parse_experiment(at_large_strain + "[dynamics]\nduration_s = 2\n" + lines, "case.toml").reference.elements;
  };
  EXPECT_FALSE(elements("").empty());
  EXPECT_FALSE(elements("equilibrium = false\nstart = \"equilibrium\"\n").empty());
  EXPECT_TRUE(elements("equilibrium = false\n").empty());
  EXPECT_TRUE(elements("equilibrium = false\n[reference]\ngrading = 2\n").empty());
  EXPECT_EQ(elements("equilibrium = false\n[reference]\nelements = [\"q1\"]\n"), std::vector<std::string>{"q1"});
}

TEST(DynamicsTable, HasOneCourseOfTheLoads) {
  const auto of = [](const std::string& lines) {
    return parse_experiment(at_large_strain + "[dynamics]\nduration_s = 2\n" + lines, "case.toml").dynamics;
  };
  EXPECT_EQ(of("pulse_s = 0.1\n")->course.pulse, 0.1);
  EXPECT_EQ(of("shake_Hz = 3\n")->course.frequency, 3);
  EXPECT_EQ(of("spin_rad_s = [0, 0, 20]\n")->spin, Vec3(0, 0, 20));
  EXPECT_EQ(of("velocity_m_s = [1, 0, 0]\n")->velocity, Vec3(1, 0, 0));
  const auto message = [](const std::string& lines) {
    return message_of(at_large_strain + "[dynamics]\nduration_s = 2\n" + lines);
  };
  EXPECT_NE(message("ramp_s = 1\npulse_s = 0.1\n").find("dynamics.pulse_s: stands beside ramp_s"), std::string::npos);
  EXPECT_NE(message("start = \"equilibrium\"\nshake_Hz = 1\n").find("dynamics.shake_Hz: does not suit"),
            std::string::npos);
  EXPECT_NE(message("pulse_s = 3\n").find("up to duration_s"), std::string::npos);
}

TEST(DynamicsTable, HasAPlaneWithFrictionForExplicitSteps) {
  const std::string moving = "[dynamics]\nduration_s = 2\n",
                    plane = "plane = { point_m = [0, 0, -1], normal = [0, 0, 2], friction = 0.3 }\n";
  const std::optional<Plane> found = parse_experiment(at_large_strain + moving + plane, "case.toml").dynamics->plane;
  ASSERT_TRUE(found);
  EXPECT_EQ(found->normal, Vec3(0, 0, 1));
  EXPECT_EQ(found->distance({5, 5, 0}), 1);
  EXPECT_EQ(found->friction, 0.3);
  EXPECT_NE(message_of(at_large_strain + moving + plane + "integrator = \"implicit_euler\"\n")
                .find("plane.friction: does not suit the large steps of implicit_euler (allowed: friction = 0, or"),
            std::string::npos);
  EXPECT_TRUE(parse_experiment(at_large_strain + moving + "integrator = \"implicit_euler\"\n" +
                                   "plane = { point_m = [0, 0, -1], normal = [0, 0, 2] }\n",
                               "case.toml")
                  .dynamics->plane);
  EXPECT_NE(message_of(at_large_strain + moving + "plane = { point_m = [0, 0, 0], normal = [0, 0, 0] }\n")
                .find("has no length"),
            std::string::npos);
}

TEST(DynamicsTable, HasAShareOfConsistentMassForExplicitSteps) {
  const std::string moving = "[dynamics]\nduration_s = 2\n", share = "mass_consistency = 0.6\n";
  EXPECT_EQ(parse_experiment(at_large_strain + moving, "case.toml").dynamics->mass_consistency, 0);
  EXPECT_EQ(parse_experiment(at_large_strain + moving + share, "case.toml").dynamics->mass_consistency, 0.6);
  const auto says = [&](const std::string& lines, const std::string& part) {
    const std::string message = message_of(at_large_strain + moving + lines);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  says("mass_consistency = 1.2\n", "dynamics.mass_consistency: is 1.2 (allowed: a share of consistent mass, 0 to 1)");
  says(share + "integrator = \"energy_momentum\"\n",
       "dynamics.mass_consistency: does not suit the integrator energy_momentum");
  says(share + "plane = { point_m = [0, 0, -1], normal = [0, 0, 2] }\n",
       "dynamics.mass_consistency: stands beside a plane");
}

TEST(DynamicsTable, AsksForFiniteElementsInTime) {
  const std::string probe = "[[probe]]\nname = \"tip\"\nat_m = [1, 1, 1]\n", asked = "[reference]\nin_time = true\n",
                    moving = "[dynamics]\nduration_s = 2\n";
  const Experiment e = parse_experiment(at_large_strain + probe + asked + moving, "case.toml");
  EXPECT_TRUE(e.reference.in_time);
  for (const char* measure : {"motion", "motion_error"})
    EXPECT_EQ(std::count(e.measures.begin(), e.measures.end(), measure), 1) << measure;
  const std::string why = "in_time integrates the motion of the case, and measures it at its probes";
  EXPECT_NE(message_of(at_large_strain + probe + asked).find(why), std::string::npos);
  EXPECT_NE(message_of(at_large_strain + asked + moving).find(why), std::string::npos);
  EXPECT_NE(message_of(at_large_strain + probe + asked + moving + "shake_Hz = 20\n").find("samples = 320 or more"),
            std::string::npos);
  const std::string compare = "[compare]\nmeasures = [\"motion_error\"]\n";
  EXPECT_NE(message_of(at_large_strain + probe + moving + compare).find("needs finite elements in time"),
            std::string::npos);
}

TEST(DynamicsTable, TheLossFactorHoldsAtBothEndsOfItsBand) {
  const MotionChoice motion =
      *parse_experiment(at_large_strain + "[dynamics]\nduration_s = 1\nloss_factor = 0.08\nband_Hz = [2, 11]\n",
                        "here.toml")
           .dynamics;
  for (const double frequency : {2.0, 11.0}) {
    const double w = 2 * std::numbers::pi * frequency;
    EXPECT_NEAR(motion.damping / (2 * w) + motion.viscosity * w / 2, 0.04, 1e-12);
  }
}

TEST(DynamicsTable, MistakesAreExplained) {
  const auto message = [](const std::string& lines) { return message_of(at_large_strain + "[dynamics]\n" + lines); };
  const auto says = [](const std::string& said, const std::string& part) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
  };
  says(message(""), "dynamics.duration_s: is missing");
  says(message("duration_s = 0"), "15:14: dynamics.duration_s: is 0 (allowed: a finite number > 0)");
  says(message("duration_s = inf"), "dynamics.duration_s");
  says(message("duration_s = 1\ntime_step_s = 0"), "dynamics.time_step_s: is 0");
  says(message("duration_s = 1\ntime_step_s = 2"), "dynamics.time_step_s: is 2");
  says(message("duration_s = 1\ndamping_1_s = -1"), "dynamics.damping_1_s: is -1");
  says(message("duration_s = 1\nviscosity_s = -1"), "dynamics.viscosity_s: is -1");
  says(message("duration_s = 1\nloss_factor = 2\nband_Hz = [1, 2]"), "dynamics.loss_factor: is 2");
  says(message("duration_s = 1\nloss_factor = 0.1"), "dynamics.loss_factor: stands without band_Hz");
  says(message("duration_s = 1\nband_Hz = [1, 2]"), "dynamics.band_Hz: stands without loss_factor");
  says(message("duration_s = 1\nloss_factor = 0.1\nband_Hz = [2, 1]"), "dynamics.band_Hz: falls");
  says(message("duration_s = 1\nloss_factor = 0.1\nband_Hz = [0, 1]"), "dynamics.band_Hz");
  says(message("duration_s = 1\nloss_factor = 0.1\nband_Hz = [1, 2]\ndamping_1_s = 1"),
       "dynamics.damping_1_s: stands beside loss_factor");
  says(message("duration_s = 1\nramp_s = 2"),
       "dynamics.ramp_s: is 2 (allowed: a finite number >= 0, up to duration_s)");
  says(message("duration_s = 1\nsamples = 1"), "dynamics.samples: is 1 (allowed: an integer from 2 to 100000)");
  says(message("duration_s = 1\nframes = -1"), "dynamics.frames: is -1");
  says(message("duration_s = 1\nintegrator = \"midpoint\""),
       "dynamics.integrator: 'midpoint' is not known (allowed: explicit, energy_momentum, implicit_euler, auto)");
  says(message("duration_s = 1\nstart = \"moving\""),
       "dynamics.start: 'moving' is not known (allowed: rest, equilibrium)");
  says(message("duration_s = 1\nstep_s = 1"), "dynamics.step_s: unknown key");
  says(message_of(std::string(test::small_case) + "[dynamics]\nduration_s = 1\n"),
       "dynamics: moves the models by their forces at large displacements");
}

}  // namespace
}  // namespace springproof::experiment_dynamics_test
