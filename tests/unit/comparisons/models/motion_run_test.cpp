// Motions of a case, from its file to its rows and histories.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "comparisons/run/case_run.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/sweep.h"
#include "support/case_file.h"

namespace springproof::motion_run_test {
namespace {

/// A cube held below and pulled above; `more` is the rest of [dynamics].
Experiment pulled_cube(const std::string& models, const std::string& more) {
  return parse_experiment(R"(kinematics = "hencky"
[body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [3, 3, 3]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
force_N = [100, 0, 300]
[[probe]]
name = "corner"
at_m = [1, 1, 1]
[compare]
models = [)" + models + R"(]
measures = ["volume_change", "reaction", "probe"]
[reference]
elements = []
[dynamics]
)" + more,
                          "cube.toml");
}

Part run_of(const Experiment& e, const std::filesystem::path& vtu = {}) {
  return run_part(prepare(e), 0, {vtu, false});
}

const HistoryRecord& history(const Part& part) {
  EXPECT_EQ(part.histories.size(), 1u);
  return part.histories.front();
}

const std::vector<double>& values_of(const HistoryRecord& h, const std::string& name) {
  const auto at = std::find(h.names.begin(), h.names.end(), name);
  EXPECT_NE(at, h.names.end()) << name;
  return h.values[at - h.names.begin()];
}

TEST(MotionRun, AtRestIsTheEquilibrium) {
  for (const char* model : {"\"hybmss\"", "\"emsm\"", "{ model = \"msm_random\", label = \"random\" }"}) {
    const Part part = run_of(pulled_cube(model, "duration_s = 25\ndamping_1_s = 3\n"));
    int compared = 0;
    for (const Row& still : part.rows)
      for (const Row& moved : part.rows)
        if (moved.model == still.model + " in motion" && moved.measure == still.measure) {
          const double scale = still.measure.starts_with("force") || still.measure.starts_with("torque") ? 300
                               : still.measure.starts_with("volume")                                     ? 1e-2
                                                                                                         : 0.03;
          EXPECT_NEAR(moved.value, still.value, 1e-6 * scale) << model << " " << still.measure;
          ++compared;
        }
    EXPECT_GE(compared, 13) << model;
  }
}

/// A ball of cut cells that sinks on its support: at rest it is where the equilibrium of anchored cells is.
void expect_equilibrium_of_a_ball(const std::string& cells) {
  const Part part = run_of(parse_experiment(R"(kinematics = "hencky"
[body]
geo = "sphere.geo"
size_m = [0.2, 0.2, 0.2]
)" + cells + R"(
[[patch]]
name = "low"
beyond = { point_m = [0.1, 0.1, 0.06], normal = [0.2, 0, -1] }
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
density_kg_m3 = 1000
[[load]]
on = "low"
displacement_m = [0, 0, 0]
[[load]]
gravity_m_s2 = [0, 0, -9.81]
[[probe]]
name = "top"
at_m = [0.1, 0.1, 0.19]
[compare]
models = ["hybmss_avg", "hybmss"]
measures = ["volume_change", "reaction", "probe"]
[reference]
elements = []
[dynamics]
duration_s = 3
damping_1_s = 15
)",
                                            "ball.toml"));
  const auto value = [&](const std::string& model, const std::string& measure) {
    for (const Row& row : part.rows)
      if (row.model == model && row.measure == measure) return row.value;
    ADD_FAILURE() << "no row " << model << " " << measure;
    return 0.0;
  };
  const std::string moved = "hybmss_avg in motion";
  const double weight = 4.0 / 3 * 3.14159265 * 1e-3 * 1000 * 9.81;
  EXPECT_NEAR(value(moved, "force.low.z"), value("hybmss_avg", "force.low.z"), 1e-4 * weight);
  for (const char* measure : {"displacement.top.z", "volume_change"}) {
    EXPECT_NEAR(value(moved, measure), value("hybmss_avg", measure), 1e-3 * std::abs(value("hybmss_avg", measure)));
    EXPECT_GT(std::abs(value("hybmss in motion", measure) / value(moved, measure) - 1), 0.002) << "whole cubes";
  }
}

TEST(MotionRun, BodiesMoveInCutCells) { expect_equilibrium_of_a_ball("voxels = 200"); }

TEST(MotionRun, BodiesMoveInCellsOfSeveralSizes) { expect_equilibrium_of_a_ball("voxels = 60\naccuracy = 0.05"); }

/// A ball of cut cells falls 5 mm; `more` is the rest of [dynamics].
Experiment falling_ball(const std::string& more, const std::string& cells = "voxels = 200") {
  return parse_experiment(R"(kinematics = "hencky"
[body]
geo = "sphere.geo"
size_m = [0.2, 0.2, 0.2]
)" + cells + R"(
[material]
youngs_modulus_Pa = 1e5
poisson_ratio = 0.3
density_kg_m3 = 1000
[[load]]
gravity_m_s2 = [0, 0, -9.81]
[compare]
models = ["hybmss_avg"]
measures = ["motion"]
[reference]
elements = []
[dynamics]
equilibrium = false
plane = { point_m = [0, 0, -0.005], normal = [0, 0, 1] }
)" + more,
                          "ball.toml");
}

// Until it lands nothing strains or turns it, and then the plane has it by its true surface.
TEST(MotionRun, ABallOfCutCellsFallsOnAPlane) {
  const Part part = run_of(falling_ball("duration_s = 0.2\nsamples = 200\n"));
  const HistoryRecord& h = history(part);
  const double mass = 4.0 / 3 * 3.14159265 * 1e-3 * 1000, lands = std::sqrt(2 * 0.005 / 9.81);
  double most = 0;
  for (std::size_t i = 0; i < h.time.size(); ++i) {
    const double p = values_of(h, "linear_momentum.z")[i], impulse = values_of(h, "contact_impulse.z")[i];
    if (h.time[i] < 0.95 * lands) {
      EXPECT_NEAR(p, -mass * 9.81 * h.time[i], 0.01 * mass * 9.81 * lands);
      EXPECT_LT(values_of(h, "elastic_energy")[i], 1e-12 * mass * 9.81 * 0.005);
      EXPECT_EQ(impulse, 0);
    }
    most = std::max(most, impulse);
  }
  EXPECT_GT(most, 1.5 * mass * 9.81 * lands) << "it bounces";
  EXPECT_LT(h.measured.at("restitution"), 1);
  EXPECT_EQ(h.measured.count("energy_drift"), 0u) << "the loss of a landing is none of the steps";
  const Part flies = run_of(falling_ball("duration_s = 0.02\nsamples = 200\n"));
  EXPECT_LT(history(flies).measured.at("energy_drift"), 0.1) << "it has not landed";
  EXPECT_GT(h.measured.at("restitution"), 0.6);
}

/// A bracket in free fall, with `more` in its case.
void expect_falls_without_turning(const std::string& models, const std::string& more) {
  const Part part = run_of(parse_experiment(R"(kinematics = "hencky"
[body]
geo = "l_bracket.geo"
size_m = [0.1, 0.05, 0.1]
voxels = 300
[material]
youngs_modulus_Pa = 1e5
poisson_ratio = 0.3
density_kg_m3 = 1000
[[load]]
gravity_m_s2 = [0, 0, -9.81]
[[probe]]
name = "end"
at_m = [0.095, 0.025, 0.01]
[compare]
measures = ["motion"]
models = )" + models + R"(
[reference]
elements = []
[dynamics]
equilibrium = false
duration_s = 0.4
samples = 40
)" + more,
                                            "bracket.toml"));
  EXPECT_GE(part.histories.size(), 3u);
  for (const HistoryRecord& h : part.histories) {
    const double t = h.time.back(), fall = 9.81 * t * t / 2;
    EXPECT_NEAR(values_of(h, "displacement.end.z").back(), -fall, 4e-3 * fall) << h.model;  // of the step
    EXPECT_NEAR(values_of(h, "displacement.end.x").back(), 0, 1e-10 * fall) << h.model;
    EXPECT_NEAR(values_of(h, "elastic_energy").back(), 0, 1e-15) << h.model;  // E V = 20 J to round-off
  }
}

// Whatever the cells or nodes at random make of its mass and its centroid.
TEST(MotionRun, InFlightEveryModelOfABodyFallsWithoutTurning) {
  expect_falls_without_turning(R"(["hybmss_avg", "hybmss", "emsm", "emsm_random"])", "");
}

TEST(MotionRun, InFlightMassesAttachedToABodyFallWithIt) {
  expect_falls_without_turning(R"(["hybmss_avg", "hybmss", "emsm"])", R"([[mass]]
name = "plate"
on = "wall"
mass_kg = 0.5
[[mass]]
name = "tool"
at_m = [0.095, 0.025, 0.01]
mass_kg = 0.2
)");
}

/// A block of 6 x 4 x 2 cells: l^2 / 6 more for each unit of mass and axis, and (4^2 + 2^2) l^2 / 12 are the body's
/// about x.
TEST(MotionRun, InFlightCornerMassesTurnTooSlowlyAndItIsSaid) {
  for (const double theta : {0.0, 0.6}) {
    const Part part = run_of(parse_experiment(R"(kinematics = "hencky"
[body]
geo = "block.geo"
size_m = [0.3, 0.2, 0.1]
cells = [6, 4, 2]
[material]
youngs_modulus_Pa = 1e5
poisson_ratio = 0.3
density_kg_m3 = 1000
[compare]
models = ["hybmss_avg"]
measures = ["motion"]
[dynamics]
equilibrium = false
duration_s = 0.02
spin_rad_s = [10, 0, 0]
mass_consistency = )" + std::to_string(theta) + "\n",
                                              "block.toml"));
    EXPECT_NEAR(history(part).measured.at("inertia_excess"), (1 - theta) * 0.2, 1e-9);
    if (theta > 0) continue;
    const double kinetic = values_of(history(part), "kinetic_energy").front(), mass = 6, inertia = mass * 0.05 / 12;
    EXPECT_NEAR(kinetic, 1.2 * inertia * 100 / 2, 1e-3 * kinetic);  // it widens within a step
  }
}

void expect_refused(const Experiment& e, const std::string& reason) {
  try {
    prepare(e);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}

TEST(MotionRun, APlaneUnderCutCellsInLargeStepsIsRefused) {
  expect_refused(falling_ball("duration_s = 0.2\nintegrator = \"energy_momentum\"\n"),
                 "dynamics.integrator: energy_momentum has a plane for nodes");
}

TEST(MotionRun, ABodyThatFliesIsNotRefined) {
  expect_refused(falling_ball("duration_s = 0.2\n", "voxels = 60\naccuracy = 0.15"),
                 "body.accuracy: cells are halved where the loads strain the body at rest, and nothing holds");
}

/// Largest error of the energy of an undamped motion from `from` to `to` [s], in steps of `step` [s].
double energy_error(const std::string& step, double from, double to) {
  const Part part = run_of(
      pulled_cube("\"hybmss\"", "duration_s = 4\nequilibrium = false\nsamples = 2000\ntime_step_s = " + step + "\n"));
  const HistoryRecord& h = history(part);
  double most = 0;
  for (std::size_t i = 0; i < h.time.size(); ++i)
    if (h.time[i] > from && h.time[i] < to)
      most = std::max(most, std::abs(values_of(h, "kinetic_energy")[i] + values_of(h, "elastic_energy")[i] +
                                     values_of(h, "load_potential")[i]));
  return most;
}

TEST(MotionRun, EnergyErrorIsOfSecondOrderInTheStepAndDoesNotGrow) {
  const double early = energy_error("0.004", 0, 2);
  EXPECT_NEAR(early / energy_error("0.002", 0, 2), 4, 0.3);
  EXPECT_LT(energy_error("0.004", 2, 4), 1.2 * early);
}

TEST(MotionRun, WhatBranchesStoreAndDissipateIsRecordedAndAddsUp) {
  for (const auto& [integrator, allowed] : {std::pair("energy_momentum", 1e-10), {"explicit", 2e-3}}) {
    const Part part = run_of(pulled_cube(
        "\"hybmss_avg\"",
        std::string("duration_s = 4\nequilibrium = false\nsamples = 400\ntime_step_s = 0.008\nintegrator = \"") +
            integrator +
            "\"\n[material.relaxation]\nbranches = [{ share = 0.4, time_s = "
            "0.2 }, { share = 0.1, time_s = 1 }]\n"));
    const HistoryRecord& h = history(part);
    const std::vector<double>& dissipated = values_of(h, "dissipated_energy");
    EXPECT_TRUE(std::is_sorted(dissipated.begin(), dissipated.end())) << integrator;
    EXPECT_GT(dissipated.back(), 0.01 * values_of(h, "elastic_energy").back()) << integrator;
    EXPECT_GT(values_of(h, "branch_energy").back(), 0) << integrator;
    EXPECT_LT(h.measured.at("energy_drift"), allowed) << integrator;
  }
}

TEST(MotionRun, LargerStepIsRefusedWithItsBoundBeforeAnythingIsRun) {
  const Experiment e = pulled_cube("\"hybmss\"", "duration_s = 2\ntime_step_s = 0.5\n");
  try {
    prepare(e);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.rfind("cube.toml:25:15: dynamics.time_step_s: 0.5 s is not safe", 0), 0u) << message;
    EXPECT_NE(message.find("allowed: up to 0.0"), std::string::npos) << message;
  }
}

// A cube released from its equilibrium: the steps are up to 30 times the safe ones.
TEST(MotionRun, EnergyMomentumKeepsTheEnergyAndItsPeriodIsThatOfSmallSteps) {
  const auto released = [](const std::string& model, const std::string& more) {
    return run_of(pulled_cube("\"" + model + "\"",
                              "duration_s = 12\nequilibrium = false\nstart = \"equilibrium\"\n"
                              "samples = 600\n" +
                                  more));
  };
  for (const char* model : {"hybmss", "hybmss_avg"}) {
    const Part part = released(model, "integrator = \"energy_momentum\"\ntime_step_s = 0.02\n");
    const HistoryRecord& h = history(part);
    EXPECT_EQ(h.integrator, "energy-momentum");
    EXPECT_LT(h.measured.at("energy_drift"), 1e-8) << model;
    EXPECT_EQ(h.probe, "displacement.corner.x") << model;
    const Part fine = released(model, "time_step_s = 0.002\n");
    EXPECT_NEAR(h.measured.at("period") / history(fine).measured.at("period"), 1, 0.02) << model;
    EXPECT_GT(history(fine).measured.at("energy_drift"), 1e-5) << model;
    EXPECT_GT(values_of(h, "displacement.corner.x").front(), 0.8 * h.measured.at("amplitude")) << model;
    EXPECT_EQ(values_of(h, "load_potential").back(), 0);
  }
}

TEST(MotionRun, AutoTakesLargeStepsWhereTheyPay) {
  const auto integrator = [](const std::string& model, const std::string& more) {
    return history(run_of(pulled_cube(model, "equilibrium = false\nintegrator = \"auto\"\nsamples = 5\n" + more)))
        .integrator;
  };
  const std::string without_kernel = R"({ model = "hybmss_avg", label = "thirteen", curve = "springs_neo_hooke" })";
  EXPECT_EQ(integrator(without_kernel, "duration_s = 2\nframes = 40\n"), "semi-implicit Euler");
  EXPECT_EQ(integrator(without_kernel, "duration_s = 30\nframes = 5\n"), "energy-momentum");
  EXPECT_EQ(integrator("\"hybmss\"", "duration_s = 30\nframes = 5\n"), "semi-implicit Euler");
}

TEST(MotionRun, AModelWithoutEnergyMomentumForcesIsRefusedWithTheReason) {
  try {
    prepare(pulled_cube("{ model = \"emsm\", label = \"emsm\", dispersion = \"published\" }",
                        "duration_s = 2\nintegrator = \"energy_momentum\"\n"));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.rfind("cube.toml:25:14: dynamics.integrator: energy_momentum does not suit", 0), 0u) << message;
    EXPECT_NE(message.find("has no energy"), std::string::npos) << message;
  }
}

TEST(MotionRun, TooManyStepsAreRefused) {
  EXPECT_THROW(prepare(pulled_cube("\"hybmss\"", "duration_s = 1e9\n")), InputError);
}

TEST(MotionRun, WritesFramesAndTheirSeries) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / "springproof_motion";
  fs::remove_all(folder);
  const Part part =
      run_of(pulled_cube("\"hybmss\"", "duration_s = 1\nequilibrium = false\nsamples = 20\nframes = 5\n"), folder);
  ASSERT_EQ(part.pictures.size(), 1u);
  EXPECT_EQ(part.pictures[0].frames.size(), part.pictures[0].frame_times.size());
  EXPECT_EQ(part.pictures[0].frames.size(), 5u);
  EXPECT_TRUE(fs::exists(folder / "hybmss_in_motion_nu0.3_3x3x3.pvd"));
  EXPECT_TRUE(fs::exists(folder / "hybmss_in_motion_nu0.3_3x3x3_0005.vtu"));
  save_part(folder / "part.cbor", "stamp", part);
  const auto again = load_part(folder / "part.cbor", "stamp");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->histories[0].values, part.histories[0].values);
  EXPECT_EQ(again->pictures[0].frames, part.pictures[0].frames);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace springproof::motion_run_test
