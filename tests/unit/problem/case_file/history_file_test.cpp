// Measured histories: files, and the values that they become.
#include "problem/case_file/experiment_parts.h"

#include <gtest/gtest.h>

#include <fstream>

#include "problem/case_file/experiment.h"
#include "problem/case_file/varied.h"
#include "problem/processes/child.h"

namespace springproof::history_file_test {
namespace {

class HistoryFile : public ::testing::Test {
 protected:
  std::filesystem::path written(const std::string& text) const {
    const auto file = folder_.path / "creep.csv";
    std::ofstream(file) << text;
    return file;
  }

  std::string refusal(const std::string& text) const {
    try {
      read_history(written(text), "mm");
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  }

  Experiment bar(const std::string& history,
                 const std::string& relaxation = "[material.relaxation]\nbranches = [{ share = 0.2, time_s = 1 }]\n") {
    const std::string text = R"(units = "mm"
[body]
geo = "block.geo"
size_mm = [100, 30, 30]
cells = [10, 3, 3]
[material]
youngs_modulus_MPa = 0.25
poisson_ratio = 0.49
density_t_mm3 = 1.07e-9
)" + relaxation + R"([[load]]
on = "x_min"
displacement_mm = [0, 0, 0]
[[load]]
gravity_mm_s2 = [0, 0, -9810]
[[mass]]
name = "weight"
on = "x_max"
mass_t = 5e-5
[compare]
measures = ["mean_displacement"]
[[load_case]]
name = "loaded"
[[load_case]]
name = "bare"
with = { mass = [] }
[[measured]]
source = "here"
licence = "none"
histories = [{ name = "creep", quantity = "mean_displacement.x_max.z", file = "creep.csv", load_case = "bare")" +
                             history + " }]\n";
    return parse_experiment(text, folder_.path / "case.toml");
  }

  TemporaryFolder folder_;
};

constexpr const char* three = "time_s,value_mm,u_mm\n0.5,-6.1,0.01\n1,-6.2,0.01\n4,-6.4,0.02\n";

TEST_F(HistoryFile, IsReadLineByLine) {
  const std::vector<HistorySample> samples = read_history(written(three), "mm");
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_EQ(samples[1].time, 1);
  EXPECT_EQ(samples[1].value, -6.2);
  EXPECT_EQ(samples[2].u, 0.02);
}

TEST_F(HistoryFile, IsRefusedAtItsLine) {
  for (const auto& [text, message] : std::initializer_list<std::pair<std::string, std::string>>{
           {"time_s,value_m,u_m\n1,2,3\n",
            "creep.csv:1:1: the columns are time_s,value_m,u_m (allowed: time_s,value_mm,u_mm)"},
           {"t,w\n1,2\n", "creep.csv:1:1: the columns are t,w (allowed: time_s,value_mm,u_mm)"},
           {"time_s,value_mm,u_mm\n1,2,0.1\n2,,0.1\n", "creep.csv:3:1: a field is empty (allowed: a number in each"},
           {"time_s,value_mm,u_mm\n1,two,0.1\n", "creep.csv:2:1: 'two' is no number (allowed: finite numbers)"},
           {"time_s,value_mm,u_mm\n1,nan,0.1\n", "creep.csv:2:1: 'nan' is no number"},
           {"time_s,value_mm,u_mm\n1,2\n", "creep.csv:2:1: has 2 fields"},
           {"time_s,value_mm,u_mm\n1,2,0.1\n0.5,2,0.1\n",
            "creep.csv:3:1: 0.5 s is not after 1 s (allowed: times that ascend from above 0)"},
           {"time_s,value_mm,u_mm\n0,2,0.1\n", "creep.csv:2:1: 0 s is not after 0 s"},
           {"time_s,value_mm,u_mm\n1,2,0\n", "creep.csv:2:1: u is 0 (allowed: a standard uncertainty > 0)"},
           {"time_s,value_mm,u_mm\n", "creep.csv:1:1: has 0 samples (allowed: 1 to 20"}})
    EXPECT_NE(refusal(text).find(message), std::string::npos) << refusal(text) << "\n" << message;
}

TEST_F(HistoryFile, BecomesValuesAfterEachTime) {
  written(three);
  const Experiment e = bar("");
  ASSERT_EQ(e.measured.size(), 3u);
  EXPECT_EQ(e.measured[1].name, "creep, 1 s");
  EXPECT_EQ(e.measured[1].history, "creep");
  EXPECT_DOUBLE_EQ(e.measured[1].value, -0.0062);
  EXPECT_DOUBLE_EQ(e.measured[1].u, 1e-5);
  EXPECT_EQ(e.load_cases.at(e.measured[1].of).name, "bare after 1 s");
  const Experiment after = varied(e, {.load_case = e.measured[1].of});
  EXPECT_EQ(after.loaded_for, 1);
  EXPECT_TRUE(after.masses.empty());
  EXPECT_FALSE(varied(e, {.load_case = 1}).loaded_for < 1e9);
}

TEST_F(HistoryFile, MayBeMeasuredFromItsLastSample) {
  written(three);
  const Experiment e = bar(", from_end = true");
  ASSERT_EQ(e.measured.size(), 2u);
  EXPECT_NEAR(e.measured[0].value, 0.3e-3, 1e-12);
  EXPECT_EQ(e.load_cases.at(e.measured[0].minus.value()).name, "bare after 4 s");
}

TEST_F(HistoryFile, HasANameOfItsOwn) {
  written(three);
  const std::string again =
      "}, { quantity = \"mean_displacement.x_max.x\", file = \"creep.csv\", load_case = \"bare\", name = ";
  EXPECT_EQ(bar(again + "\"other\"").measured.size(), 6u);
  try {
    bar(again + "\"creep\"");
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("'creep' is the name of a history (allowed: a name of its own)"),
              std::string::npos)
        << e.what();
  }
}

TEST_F(HistoryFile, NeedsAMaterialThatRelaxesAndAFile) {
  written(three);
  EXPECT_THROW(bar("", ""), InputError);
  std::filesystem::remove(folder_.path / "creep.csv");
  EXPECT_THROW(bar(""), InputError);
}

}  // namespace
}  // namespace springproof::history_file_test
