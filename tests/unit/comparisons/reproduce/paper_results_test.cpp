// Results of others, from which figures are drawn.
#include "comparisons/reproduce/paper_results.h"

#include <gtest/gtest.h>

#include "comparisons/results/crack_picture.h"
#include "problem/files/files.h"
#include "problem/processes/child.h"
#include "problem/system/input_error.h"

namespace springproof::paper_results_test {
namespace {

const std::string row =
    R"({"model": "m", "poisson_ratio": 0.25, "cells": [1, 1, 1], "kinematics": "linear", "measure": "cracks",
        "value": 1, "unit": "1", "reference": null, "reference_uncertainty": null})";

/// results.json of one case with these lists.
std::string results(const std::string& lists) {
  return R"({"program": {"version": "0.1.0"}, "generated": "now", "cases": [{"experiment": {"folder": "a", "name": "b"},
             "rows": [)" +
         row + "]" + lists + "}]}";
}
const std::string lists = R"(, "checks": [], "published": [], "lines": [], "runs": [])";

std::string refusal(const std::filesystem::path& folder) {
  try {
    const PaperResults results({folder});
    results.cracks("a/b", "m");
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(PaperResults, WithoutOneOfTheirListsAreRefusedByName) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "results.json";
  write_file(file, results(lists));
  EXPECT_EQ(refusal(folder.path), "accepted");
  for (const std::string name : {"checks", "published", "lines", "runs"}) {
    std::string less = lists;
    less.replace(less.find(name), name.size(), "others_" + name);
    write_file(file, results(less));
    EXPECT_TRUE(refusal(folder.path).starts_with(file.string() + ": not the results of")) << refusal(folder.path);
    EXPECT_NE(refusal(folder.path).find("'" + name + "'"), std::string::npos) << refusal(folder.path);
  }
}

TEST(PaperResults, TakeNoDrawingOfOthers) {
  const TemporaryFolder folder;
  write_file(folder.path / "results.json", results(lists));
  const std::filesystem::path file = folder.path / crack_file("b", {"m", 0.25, {1, 1, 1}});
  write_file(file, crack_svg({{0, 0, 1, 1}}, {}));
  EXPECT_EQ(refusal(folder.path), "accepted");
  write_file(file, "<svg xmlns=\"http://www.w3.org/2000/svg\"><script>alert(1)</script></svg>");
  EXPECT_TRUE(refusal(folder.path).starts_with(file.string() + ": is no drawing of cracks by")) << refusal(folder.path);
}

}  // namespace
}  // namespace springproof::paper_results_test
