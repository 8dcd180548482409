#include "comparisons/judge/differences.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "problem/files/files.h"
#include "problem/system/input_error.h"

namespace springproof::differences_test {
namespace {

Row row(const std::string& measure, double value, std::optional<double> reference = {},
        std::optional<double> uncertainty = {}) {
  Row r;
  r.case_name = "golec_2019/bending";
  r.kinematics = "linear";
  r.model = "hybmss";
  r.poisson_ratio = 0.25;
  r.cells = {24, 4, 4};
  r.measure = measure;
  r.value = value;
  r.unit = "m";
  r.reference = reference;
  r.reference_uncertainty = uncertainty;
  return r;
}

const ResultsFolder results = {
    "0.1.0",
    "2026-01-01T00:00:00Z",
    {row("displacement.tip.x", 1e-12), row("displacement.tip.z", -0.25, -0.24, 1e-3), row("volume_change", -0.01)},
    {},
    {}};

TEST(Differences, OfAFolderWithItselfAreNone) {
  const Differences d = differences(results, results, 0);
  EXPECT_TRUE(d.none());
  EXPECT_EQ(d.in_both, 3u);
  EXPECT_EQ(d.largest, 0);
}

TEST(Differences, AreThoseBeyondTheToleranceWithTheLargestFirst) {
  ResultsFolder other = results;
  other.rows[1].value = -0.25 * (1 + 1e-6);
  other.rows[2].value = -0.0105;
  const Differences d = differences(results, other, 1e-5);
  ASSERT_EQ(d.changed.size(), 1u);
  EXPECT_EQ(d.changed[0].row.measure, "volume_change");
  EXPECT_NEAR(d.changed[0].relative, 0.0005 / 0.0105, 1e-12);
  EXPECT_TRUE(std::isnan(d.changed[0].of_uncertainty));
  const Differences finer = differences(results, other, 1e-7);
  ASSERT_EQ(finer.changed.size(), 2u);
  EXPECT_EQ(finer.changed[1].row.measure, "displacement.tip.z");
  EXPECT_NEAR(finer.changed[1].of_uncertainty, 0.25e-6 / 1e-3, 1e-12);
}

TEST(Differences, OfAComponentThatVanishesAreRelativeToTheVector) {
  ResultsFolder other = results;
  other.rows[0].value = -3e-12;  // of a vector of 0.25
  EXPECT_TRUE(differences(results, other, 1e-9).none());
  other.rows[0].value = 1e-3;
  EXPECT_EQ(differences(results, other, 1e-9).changed.size(), 1u);
}

TEST(Differences, IncludeTheReferenceAndWhatIsNoNumber) {
  ResultsFolder other = results;
  other.rows[1].reference = -0.2401;
  other.rows[1].reference_uncertainty.reset();
  other.rows[2].value = std::numeric_limits<double>::quiet_NaN();
  const Differences d = differences(results, other, 1e-9);
  ASSERT_EQ(d.changed.size(), 3u);
  EXPECT_TRUE(std::isinf(d.changed[0].relative));
  EXPECT_EQ(d.changed[2].what, "reference");
  EXPECT_NEAR(d.changed[2].of_uncertainty, 0.1, 1e-12);
}

TEST(Differences, NameWhatOnlyOneOfTheTwoHas) {
  ResultsFolder other = results;
  other.rows[0].cells = {48, 8, 8};
  other.rows.push_back(row("displacement_error", 0.01));
  const Differences d = differences(results, other, 1e-9);
  EXPECT_EQ(d.in_both, 2u);
  ASSERT_EQ(d.only_first.size(), 1u);
  EXPECT_EQ(d.only_first[0].measure, "displacement.tip.x");
  EXPECT_EQ(d.only_second.size(), 2u);
}

TEST(Differences, OfUnitsAreDifferencesWhateverTheNumbers) {
  ResultsFolder other = results;
  other.rows[1].unit = "mm";
  const Differences d = differences(results, other, 1e-9);
  ASSERT_EQ(d.changed.size(), 1u);
  EXPECT_EQ(d.changed[0].what, "unit mm for m");
  EXPECT_TRUE(std::isinf(d.largest));
}

TEST(Differences, ANumberThatAFolderHoldsTwiceIsComparedOnce) {
  ResultsFolder twice = results;
  twice.rows.insert(twice.rows.begin(), row("volume_change", -0.01));
  twice.rows.back().value = -0.5;
  const Differences d = differences(results, twice, 1e-9), reversed = differences(twice, results, 1e-9);
  EXPECT_TRUE(d.changed.empty());  // the first with the first
  ASSERT_EQ(d.only_second.size(), 1u);
  EXPECT_EQ(d.only_second[0].value, -0.5);
  ASSERT_EQ(reversed.only_first.size(), 1u);
  EXPECT_EQ(reversed.only_first[0].value, -0.5);
  EXPECT_TRUE(differences(twice, twice, 0).none());
}

TEST(ResultsFolder, WithoutResultsIsRefused) {
  const auto folder = std::filesystem::temp_directory_path() / "springproof_differences_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  EXPECT_THROW(read_results(folder), InputError);
  write_file(folder / "results.json", R"({"cases": [{}]})");
  EXPECT_THROW(read_results(folder), InputError);
  write_file(folder / "results.json",
             R"({"program": {"version": "0.1.0"}, "generated": "now", "cases": [{"experiment": {"folder": "a", "name":
             "b"}, "rows": [{"model": "hybmss", "poisson_ratio": 0.25, "cells": [1, 2, 3], "kinematics": "linear",
             "measure": "volume_change", "value": null, "unit": "1", "reference": 2.5, "reference_uncertainty": null}]}]})");
  const ResultsFolder found = read_results(folder);
  ASSERT_EQ(found.rows.size(), 1u);
  EXPECT_EQ(found.rows[0].case_name, "a/b");
  EXPECT_TRUE(std::isnan(found.rows[0].value));
  EXPECT_EQ(found.rows[0].reference, 2.5);
  EXPECT_FALSE(found.rows[0].reference_uncertainty);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace springproof::differences_test
