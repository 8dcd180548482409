// What is said of a run under way: lines, times, what is left.
#include "comparisons/sweep/status.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>

#include "comparisons/run/expected_runs.h"
#include "comparisons/sweep/time_left.h"
#include "meshes/mesh.h"

namespace springproof::status_test {
namespace {

const Activity solving{"[3/8] beam  nu0.3", "finite elements 2 of 5, q2 on 12 x 12 x 12 cells",
                       "46875 unknowns, iteration 12", 42, 21};
const Activity waiting{"[4/8] cube  nu0.3", "hybmss on 10 x 10 x 10 cells", "", 3, 1};

TEST(Status, TimesAreAsExactAsTheyAreWorth) {
  EXPECT_EQ(time_words(0.4), "0 s");
  EXPECT_EQ(time_words(99.4), "99 s");
  EXPECT_EQ(time_words(99.6), "2 min");
  EXPECT_EQ(time_words(59 * 60), "59 min");
  EXPECT_EQ(time_words(3600 * 2 - 20), "2 h");
  EXPECT_EQ(time_words(4700), "78 min");
  EXPECT_EQ(time_words(7900), "2 h 10 min");
}

TEST(Status, LiveLineSaysPartPhaseDetailTimeAndWhatIsLeft) {
  EXPECT_EQ(live_line({solving}, {52, 130}, 200),
            "[##........] [3/8] beam  nu0.3: finite elements 2 of 5, q2 on 12 x 12 x 12 cells, 46875 unknowns, "
            "iteration 12, 42 s, "
            "about 2 min left");
  EXPECT_EQ(live_line({waiting}, {}, 200), "[4/8] cube  nu0.3: hybmss on 10 x 10 x 10 cells, 3 s");
  EXPECT_EQ(live_line({}, {1, 3}, 200), "");
}

TEST(Status, SeveralPartsAreOneLine) {
  const std::string line = live_line({solving, waiting, waiting}, {60, 20}, 200);
  EXPECT_TRUE(line.starts_with("[#######...] [3/8] beam")) << line;
  EXPECT_TRUE(line.ends_with(", 42 s, about 20 s left (and 2 more)")) << line;
}

TEST(Status, LiveLineIsCutToTheTerminalButNotItsEnd) {
  for (const std::size_t width : {40u, 60u, 79u}) {
    const std::string line = live_line({solving}, {0, 130}, width);
    EXPECT_EQ(line.size(), width);
    EXPECT_TRUE(line.ends_with("..., 42 s, about 2 min left")) << line;
    EXPECT_EQ(line.starts_with("[..........] "), width == 79u) << line;
  }
  for (std::size_t width = 0; width < 40; ++width)
    EXPECT_LE(live_line({solving, waiting}, {0, 130}, width).size(), width);
}

TEST(Status, LettersOfSeveralBytesAreCutWhole) {
  Activity greek = waiting;
  greek.title = "\u03bb\u03bb\u03bb\u03bb\u03bb\u03bb\u03bb\u03bb\u03bb\u03bb";
  EXPECT_EQ(live_line({greek}, {}, 14), "\u03bb\u03bb\u03bb\u03bb\u03bb\u03bb..., 3 s");
}

TEST(Status, PhaseLineSaysHowLongItHasTaken) {
  EXPECT_EQ(phase_line(waiting, 600.0),
            "  [4/8] cube  nu0.3: hybmss on 10 x 10 x 10 cells (1 s so far, about 10 min left)");
}

/// Parts of two runs of springs each, which take what they take.
std::vector<std::vector<RunCost>> parts_of(const std::vector<double>& seconds) {
  std::vector<std::vector<RunCost>> parts;
  for (const double s : seconds) parts.push_back({{RunKind::springs, s / 4}, {RunKind::springs, 3 * s / 4}});
  return parts;
}

TEST(TimeLeft, StartsFromWhatIsExpected) {
  const TimeLeft two_at_once(parts_of({10, 20, 30}), 2);
  EXPECT_DOUBLE_EQ(*two_at_once.at(0), 30);  // not less than the longest
  const TimeLeft one_at_a_time(parts_of({10, 20, 30}), 1);
  EXPECT_DOUBLE_EQ(*one_at_a_time.at(0), 60);
}

/// The first run tells of the others of its kind, before its part is finished.
TEST(TimeLeft, LearnsFromTheRunsThatAreDone) {
  TimeLeft left(parts_of({4000, 4000}), 1);
  left.started(0, 0);
  EXPECT_DOUBLE_EQ(*left.at(10), 7990);
  left.ran(0, {RunKind::springs, 1000}, 100, 100);  // ten times as fast as expected
  EXPECT_NEAR(*left.at(100), 700, 10);
  left.ran(0, {RunKind::springs, 3000}, 300, 400);
  left.finished(0);
  EXPECT_NEAR(*left.at(400), 400, 10);
  left.started(1, 400);
  EXPECT_NEAR(*left.at(500), 300, 10);
}

/// Finite elements that take longer say nothing of springs; what a part has shown of itself counts before others.
TEST(TimeLeft, KindsAndPartsHaveRatesOfTheirOwn) {
  const std::vector<RunCost> runs = {{RunKind::matrix_free, 100}, {RunKind::matrix_free, 100}, {RunKind::springs, 100}};
  TimeLeft left({runs, runs}, 1);
  left.started(0, 0);
  left.ran(0, runs[0], 1000, 1000);
  EXPECT_NEAR(*left.at(1000), (1000 + 100) + (2000 + 100), 50);
  left.started(1, 1000);
  left.ran(1, runs[0], 100, 1100);
  EXPECT_NEAR(*left.at(1100), (1000 - 100 + 100) + (100 + 100), 50);
}

/// The start of a program takes longer than a small grid.
TEST(TimeLeft, ShortRunsSayLittle) {
  TimeLeft left({{{RunKind::matrix_free, 0.03}, {RunKind::matrix_free, 60}}}, 1);
  left.started(0, 0);
  left.ran(0, {RunKind::matrix_free, 0.03}, 0.6, 0.6);
  EXPECT_LT(*left.at(0.6), 150);
}

/// Whatever was expected of it: a run that lasts for four minutes is not "about 3 s" from its end.
TEST(TimeLeft, ARunThatTakesLongerIsNotAboutToEnd) {
  TimeLeft left({{{RunKind::matrix_free, 3}}}, 1);
  left.started(0, 0);
  EXPECT_DOUBLE_EQ(*left.at(1), 2);
  for (const double t : {4., 40., 240.}) EXPECT_GE(*left.at(t), t / 2) << t;
  left.finished(0);
  EXPECT_FALSE(left.at(250));
}

TEST(TimeLeft, WhatIsKeptFromBeforeTellsNothing) {
  TimeLeft left(parts_of({10, 20}), 1);
  left.started(0, 0);
  left.ran(0, {RunKind::springs, 2.5}, {}, 0);
  EXPECT_DOUBLE_EQ(*left.at(0), 27.5);
  left.finished(0);
  EXPECT_DOUBLE_EQ(*left.at(0), 20);
}

/// What the code above `scope` writes to standard error, which is no terminal here.
template <class Scope>
std::string errors_of(const Scope& scope) {
  testing::internal::CaptureStderr();
  scope();
  return testing::internal::GetCapturedStderr();
}

TEST(Status, IsSilentOnShortPhases) {
  EXPECT_EQ(errors_of([] {
              Status status;
              const Status::Working working(status, "cube");
              progress::phase("hybmss");
              std::this_thread::sleep_for(std::chrono::milliseconds(500));
            }),
            "");
}

TEST(Status, PrintsWhatIsToStay) {
  EXPECT_EQ(errors_of([] {
              Status status(true);
              status.print("done");
            }),
            "done\n");
}

PreparedCase block_case(int reference, double nu) {
  PreparedCase prepared;
  prepared.experiment.materials = {{1e4, nu, 1000}};
  prepared.experiment.models = {{"hybmss", {}, "hybmss", {}}};
  prepared.models = {resolve(prepared.experiment.models[0])};
  add_lattice({{4, 4, 4}, std::make_shared<Mesh>(block_mesh({1, 1, 1}, {4, 4, 4}))}, prepared);
  prepared.reference_cells = {reference, reference, reference};
  return prepared;
}

TEST(ExpectedSeconds, GrowWithTheReferenceTheRatioAndTheStrain) {
  const auto seconds = [](const PreparedCase& p) { return sum_of(expected_runs(p, p.experiment.materials[0])); };
  PreparedCase fine = block_case(32, 0.3);
  EXPECT_GT(seconds(fine), 5 * seconds(block_case(16, 0.3)));
  EXPECT_GT(seconds(block_case(32, 0.499)), 1.5 * seconds(fine));
  const double linear = seconds(fine);
  fine.experiment.kinematics = "hencky";
  EXPECT_GT(seconds(fine), 3 * linear);
}

std::string case_text(const std::string& body, double nu) {
  return fmt::format(R"(
[body]
{}
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = {}
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[compare]
models = ["hybmss"]
)",
                     body, nu);
}

TEST(ExpectedSeconds, OfABlockNeedNoMesh) {
  for (const double nu : {0.3, 0.499}) {
    PreparedCase prepared = block_case(16, nu);
    const Experiment e = parse_experiment(case_text("geo = \"block.geo\"\nsize_m = [1, 1, 1]\ncells = [4, 4, 4]", nu) +
                                              "[reference]\ncells = [16, 16, 16]",
                                          "case.toml");
    prepared.experiment.reference = e.reference;
    const double meshed = sum_of(expected_runs(prepared, e.materials[0]));
    EXPECT_NEAR(unmeshed_seconds(e, e.materials[0]), meshed, 0.01 * meshed);
  }
}

TEST(ExpectedSeconds, OfVoxelsGrowWithTheirNumberBeforeTheyAreMeshed) {
  const auto seconds = [](const std::string& body, const std::string& more = "") {
    const Experiment e = parse_experiment(case_text(body, 0.3) + more, "case.toml");
    return unmeshed_seconds(e, e.materials[0]);
  };
  const std::string few_voxels = "geo = \"beam.geo\"\nsize_m = [1, 1, 1]\nvoxels = 500",
                    parts = "parts = true\n";  // of [compare]
  const double few = seconds(few_voxels);
  EXPECT_GT(seconds(few_voxels + "0"), few);
  EXPECT_GT(seconds(few_voxels + "0", parts), 3 * seconds(few_voxels, parts));
  EXPECT_NEAR(seconds("geo = \"beam.geo\"\nsize_m = [1, 1, 1]\nvoxel_edge_m = 0.1"), few, 0.01 * few);
  EXPECT_GT(seconds("geo = \"beam.stl\"\nvoxel_edge_m = 0.1"), few);
}

TEST(ExpectedSeconds, OfAMotionAreFiniteThoughTheSizeOfTheBodyIsNotKnown) {
  std::string text = case_text("geo = \"organ.stl\"\nvoxels = 1500", 0.3) + "[dynamics]\nduration_s = 1\n";
  const Experiment e = parse_experiment("kinematics = \"hencky\"\n" + text, "case.toml");
  EXPECT_TRUE(std::isfinite(unmeshed_seconds(e, e.materials[0])));
}

}  // namespace
}  // namespace springproof::status_test
