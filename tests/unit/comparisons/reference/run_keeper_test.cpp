// The runs of a part: kept one by one, and taken back.
#include "comparisons/reference/run_keeper.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "comparisons/run/case_run.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/sweep.h"
#include "fem_reference/exchange/reference.h"
#include "problem/case_file/experiment.h"
#include "problem/files/files.h"
#include "problem/processes/child.h"

namespace springproof::run_keeper_test {
namespace {

namespace fs = std::filesystem;

/// A keeper of runs that are numbers, and how often one was made.
struct Numbers {
  RunKeeper keeper;
  int made = 0;
  std::vector<std::optional<double>> took;

  Numbers(const fs::path& folder, const std::string& stamp)
      : keeper(folder, stamp, [this](const RunCost&, std::optional<double> t) { took.push_back(t); }) {}

  int run(const std::string& name, int number) {
    return keeper.run(name, {}, [&] { return ++made, number; });
  }
};

TEST(RunKeeper, TakesBackWhatIsFinishedOfTheSameInputs) {
  const TemporaryFolder folder;
  const fs::path runs = folder.path / "case.runs";
  Numbers first(runs, "inputs");
  EXPECT_EQ(first.run("a", 7), 7);
  Numbers again(runs, "inputs"), others(runs, "other inputs");
  EXPECT_EQ(again.run("a", 8), 7);
  EXPECT_EQ(again.run("b", 8), 8);
  EXPECT_EQ(again.made, 1);
  ASSERT_EQ(again.took.size(), 2u);
  EXPECT_FALSE(again.took[0]);
  EXPECT_TRUE(again.took[1]);
  EXPECT_EQ(again.run("a", 9), 7);
  EXPECT_EQ(again.took.size(), 2u);  // told once
  EXPECT_EQ(others.run("a", 9), 9);
}

TEST(RunKeeper, MakesADamagedRunAnew) {
  const TemporaryFolder folder;
  const fs::path runs = folder.path / "case.runs", file = runs / "a.run";
  Numbers(runs, "").run("a", 1000);
  const std::string whole = text_of_file(file);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    write_file(file, damaged);
    testing::internal::CaptureStderr();
    EXPECT_EQ(Numbers(runs, "").run("a", 5), 5) << at;
    EXPECT_NE(testing::internal::GetCapturedStderr().find("a.run is damaged; this run is made anew"),
              std::string::npos);
  }
}

TEST(RunKeeper, ForgetsItsOwnFilesAlone) {
  const TemporaryFolder folder;
  const fs::path runs = folder.path / "case.runs";
  Numbers n(runs, "");
  n.run("a", 1);
  write_file(runs / "letter.txt", "mine");
  write_file(runs / "a.run.0123.part", "of a program that was killed");
  n.keeper.forget();
  EXPECT_TRUE(fs::exists(runs / "letter.txt"));
  EXPECT_EQ(std::distance(fs::directory_iterator(runs), {}), 1);
  fs::remove(runs / "letter.txt");
  n.keeper.forget();
  EXPECT_FALSE(fs::exists(runs));
}

/// Of a kept run nothing is lost that the results are made of: a part of runs that are all taken back is the same part.
TEST(RunKeeper, APartOfKeptRunsIsThePart) {
  if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  const std::string cube = R"(
[body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [[2, 2, 2], [3, 3, 3]]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
density_kg_m3 = 1000
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
displacement_m = [0, 0, 0.01]
[reference]
cells = [4, 4, 4]
[compare]
)";
  const std::string at_rest = R"(models = ["hybmss_avg", {model = "msm_random", seeds = 2}, "emsm"]
elements = ["q1"])",
                    in_motion = R"(models = ["hybmss_avg"]
measures = ["motion", "displacement_error"]
[dynamics]
duration_s = 0.05)";
  for (const std::string& text : {cube + at_rest, "kinematics = \"hencky\"\n" + cube + in_motion}) {
    const PreparedCase prepared = prepare(parse_experiment(text, "cube.toml"));
    const TemporaryFolder folder;
    int made = 0;
    const RunKeeper keeper(folder.path / "cube.runs", "",
                           [&](const RunCost&, const auto& took) { made += took.has_value(); });
    const auto bytes = [&](const RunKeeper& k) {
      Part part = run_part(prepared, 0, {}, k);
      for (auto& run : part.runs) run.seconds = run.set_up_seconds = run.memory_MiB = 0;
      save_part(folder.path / "part", "", part);
      return text_of_file(folder.path / "part");
    };
    const std::string plain = bytes({}), first = bytes(keeper);
    EXPECT_EQ(plain, first);
    const RunKeeper again(folder.path / "cube.runs", "", [&](const RunCost&, const auto& took) { EXPECT_FALSE(took); });
    EXPECT_EQ(bytes(again), first);
    EXPECT_GE(made, 5);
  }
}

}  // namespace
}  // namespace springproof::run_keeper_test
