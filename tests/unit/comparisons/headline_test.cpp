#include "comparisons/headline.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/comparisons/sample_case.h"

namespace springproof {
namespace {

using Json = nlohmann::json;

struct Point {
  double nu;
  int cells;
  double error;
};

/// A case of one model with displacement errors alone.
CaseResult with_errors(const std::string& name, const std::string& model, const std::vector<Point>& points) {
  CaseResult c;
  c.experiment.name = name;
  c.experiment.models = {{model, {}, model, {}}};
  for (const Point& p : points) {
    const Cells cells = {p.cells, p.cells, p.cells};
    c.runs.push_back({model, "msm", p.nu, cells, "linear", true, "", "", 1, 0, 0, 0});
    c.rows.push_back(
        {name, "linear", model, p.nu, cells, "displacement_error", p.error, "1", {}, 1e-4, p.error});
  }
  return c;
}

Headline headline_of(const std::vector<CaseResult>& cases) {
  Json results = {{"cases", Json::array()}};
  for (const auto& c : cases) results["cases"].push_back(to_json(c));
  return headline(results);
}

TEST(Headline, TakesTheWorstOfAllCasesAtTheFinestCells) {
  const Headline h =
      headline_of({with_errors("shear", "hybmss", {{0, 10, 0.5}, {0, 20, 0.002}, {0.4, 20, 0.003}}),
                   with_errors("torsion", "hybmss", {{0, 20, 0.001}, {0.4, 20, 0.0082}})});
  ASSERT_EQ(h.models.size(), 1u);
  EXPECT_EQ(h.models[0].sentence,
            "displacement within 0.82 % of FEM for ν from 0 to 0.4 (worst: torsion at ν = 0.4).");
  EXPECT_EQ(h.answer,
            "Of the spring models hybmss comes closest: its displacements stay within 0.82 % of finite "
            "elements for ν "
            "from 0 to 0.4, in 2 linear cases.");
}

TEST(Headline, TetrahedraAndLongPoissonsRatiosAreReadable) {
  CaseResult c = with_errors("hand", "hybmss", {{0.4999750012499375, 10, 0.5}});
  c.runs[0].ok = false;
  c.runs[0].cells = {812, 0, 0};
  c.rows[0].cells = {812, 0, 0};
  c.rows.push_back({"hand", "linear", "hybmss", 0.4999750012499375, {100, 0, 0}, "displacement_error", 0.7, "1", {}, 1e-4, 0.7});
  const Headline h = headline_of({c});
  EXPECT_EQ(h.failed_runs.at(0), "hand: hybmss at ν = 0.499975, 812 tets: no reason given");
  EXPECT_EQ(h.models[0].sentence, "displacement within 50 % of FEM at ν = 0.499975 (worst: hand at ν = 0.499975).")
      << "the finer mesh counts";
}

TEST(Headline, ACaseWithoutModelsIsJudgedByItsExpectationsAlone) {
  CaseResult c = with_errors("plate", "fem_p1", {{0, 10, 0.5}});
  c.experiment.models.clear();
  c.checks.push_back({"fem_p1", 0, {10, 10, 10}, "displacement_error_order", "1", "analytic", 1.9, 1.2, 0, 0.0, Verdict::fail, "", true});
  const Headline h = headline_of({c});
  EXPECT_TRUE(h.models.empty());
  ASSERT_EQ(h.failed_checks.size(), 1u);
  EXPECT_NE(h.failed_checks[0].find("computed 1.2, expected at least 1.9"), std::string::npos) << h.failed_checks[0];
}

TEST(Headline, SaysWhereATighterBoundHolds) {
  const Headline h = headline_of({with_errors(
      "shear", "msm",
      {{-0.2, 10, 0.2}, {0.2, 10, 0.009}, {0.25, 10, 0.001}, {0.3, 10, 0.011}, {0.4, 10, 0.01}})});
  EXPECT_EQ(h.models[0].sentence,
            "displacement within 20 % of FEM for ν from −0.2 to 0.4 (worst: shear at ν = −0.2); within 1 % "
            "for ν from "
            "0.2 to 0.25 and at ν = 0.4.");
}

TEST(Headline, SaysWhenTheErrorIsBelowTheUncertainty) {
  const Headline h = headline_of({with_errors("shear", "hybmss", {{0.25, 10, 5e-5}})});
  EXPECT_EQ(h.models[0].sentence,
            "displacement within 0.005 % of FEM at ν = 0.25 (worst: shear at ν = 0.25, below the 0.01 % "
            "uncertainty of "
            "the reference).");
}

TEST(Headline, AModelThatRanInFewerCasesIsNotTheClosest) {
  const Headline h = headline_of({with_errors("shear", "emsm", {{0, 10, 0.02}}),
                                  with_errors("torsion", "emsm", {{0, 10, 0.02}}),
                                  with_errors("shear", "lucky", {{0, 10, 1e-3}})});
  EXPECT_EQ(h.answer.find("Of the spring models emsm comes closest"), 0u) << h.answer;
}

TEST(Headline, FiniteElementsAreComparedButNeverTheClosest) {
  CaseResult fem = with_errors("shear", "fem_q1", {{0, 10, 1e-3}});
  fem.runs[0].kind = "fem";
  const Headline h = headline_of({fem, with_errors("shear", "emsm", {{0, 10, 0.02}})});
  ASSERT_EQ(h.models.size(), 2u);
  EXPECT_EQ(h.models[0].model, "emsm");
  EXPECT_TRUE(h.models[1].finite_elements);
  EXPECT_NE(h.answer.find("emsm"), std::string::npos);
}

TEST(Headline, LargeDeformationIsKeptApart) {
  CaseResult large = with_errors("torsion_45", "hybmss", {{0, 10, 0.3}});
  large.experiment.kinematics = "hencky";
  const Headline h = headline_of({large, with_errors("shear", "hybmss", {{0, 10, 0.002}})});
  ASSERT_EQ(h.models.size(), 2u);
  EXPECT_FALSE(h.models[0].large_deformation);
  EXPECT_NE(h.models[0].sentence.find("within 0.2 %"), std::string::npos);
  EXPECT_TRUE(h.models[1].large_deformation);
  EXPECT_NE(h.models[1].sentence.find("within 30 %"), std::string::npos);
  EXPECT_EQ(headline_of({large}).answer, "");
}

TEST(Headline, VolumeIsToldInPercentagePoints) {
  CaseResult c = with_errors("shear", "hybmss", {{0, 10, 0.002}});
  c.rows.push_back(
      {"shear", "linear", "hybmss", 0, {10, 10, 10}, "volume_change", 0.05, "1", 0.0507, 1e-5, -0.0007});
  EXPECT_NE(headline_of({c}).models[0].sentence.find("; volume change within 0.07 percentage points."),
            std::string::npos);
}

TEST(Headline, CountsExpectationsAndListsWhatWentWrong) {
  const Headline h = headline_of({sample_case()});
  EXPECT_EQ(h.held, 1);
  EXPECT_EQ(h.failed, 1);
  ASSERT_EQ(h.failed_checks.size(), 1u);
  EXPECT_EQ(h.failed_checks[0],
            "compress: hybmss, displacement_error at ν = 0.4, 2×2×2 cells: computed 0.02, expected 0 ± 0.01 "
            "(extrapolated FEM, sec. 6)");
  ASSERT_EQ(h.failed_runs.size(), 1u);
  EXPECT_EQ(h.failed_runs[0], "compress: emsm at ν = 0.4, 2×2×2 cells: diverged at load 0.3");
  EXPECT_EQ(expectations_sentence(h), "1 of 2 expectations hold, 1 fails.");
}

TEST(Headline, AModelWithoutAnyResultIsSaidToHaveNone) {
  const Headline h = headline_of({sample_case()});
  ASSERT_EQ(h.models.size(), 2u);
  EXPECT_EQ(h.models[1].model, "emsm");
  EXPECT_EQ(h.models[1].sentence, "no displacement could be compared.");
}

TEST(Headline, NothingRunIsNothingSaid) {
  const Headline h = headline(Json::object());
  EXPECT_TRUE(h.models.empty());
  EXPECT_EQ(h.answer, "");
  EXPECT_EQ(expectations_sentence(h), "No expectations are stated.");
}

}  // namespace
}  // namespace springproof
