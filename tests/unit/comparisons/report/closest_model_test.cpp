// Which model the headline names, how sure of the reference it is, and what is no success.
#include <gtest/gtest.h>

#include "problem/case_file/experiment.h"
#include "unit/comparisons/report/headline_cases.h"

namespace springproof::closest_model_test {
namespace {

using namespace test;

// ---- which model comes closest

TEST(ClosestModel, TheWholeErrorDecidesAndNotTheSpringsOwnPart) {
  CaseResult bracket = with_models("bracket", 0.3, 0.041, {{"hybmss_avg", 0.065}, {"emsm", 0.12}});
  for (auto& run : bracket.runs) run.filled = 800;
  for (const auto& [model, own] : {std::pair("hybmss_avg", 0.09), {"emsm", 0.0023}})
    bracket.splits.push_back({{model, 0.3, {10, 10, 10}}, 0.01, "displacement_error", "1", 0.065, own, 0.05, 0, 0, 0});
  add_row(bracket, "hybmss_avg", 0.3, "promised_error", 0.08, 0);
  const Headline h = headline({bracket});
  EXPECT_EQ(h.answer,
            "Of the spring models hybmss_avg comes closest: its displacements are within 6.5 % of finite elements, as "
            "far as these can tell: they are uncertain by 4.1 %, at ν = 0.3, in 1 linear case of 800 cells.");
  EXPECT_NE(h.models[0].sentence.find("; its cells estimate 8 %."), std::string::npos) << h.models[0].sentence;
}

TEST(ClosestModel, AModelIsNotRankedBesideItsOwnExtrapolation) {
  const Headline h =
      headline({with_models("ball", 0.3, 1e-4, {{"hybmss_avg extrapolated", 0.0067}, {"hybmss_avg", 0.013}})});
  EXPECT_EQ(h.answer.find("hybmss_avg: its displacements are within 1.3 % of finite elements"), 0u) << h.answer;
  ASSERT_EQ(h.models.size(), 2u);
  EXPECT_EQ(h.models[0].model, "hybmss_avg");
  EXPECT_TRUE(h.models[1].beside);
}

TEST(ClosestModel, AModelFromAFileIsRankedUnlessItIsOnlyShown) {
  CaseResult bar = with_models("bar", 0.3, 1e-4, {{"emsm", 0.066}, {"mine", 0.054}});
  bar.experiment.models[1].name = external_model;
  bar.runs[1].kind = "external";
  EXPECT_EQ(headline({bar}).answer.find("Of the spring models mine comes closest: its displacements are within 5.4 %"),
            0u);
  bar.experiment.models[1].options["springs"] = false;
  const Headline shown = headline({bar});
  EXPECT_EQ(shown.answer.find("emsm: its displacements are within 6.6 %"), 0u) << shown.answer;
  EXPECT_TRUE(shown.models.at(1).beside);
}

TEST(ClosestModel, ModelsAreListedAsTheyAreRanked) {
  const Headline h = headline({with_models("bar", 0.3, 1e-4, {{"emsm", 0.066}, {"hybmss", 0.02}, {"msm_18", 0.01}})});
  std::vector<std::string> names;
  for (const ModelVerdict& v : h.models) names.push_back(v.model);
  EXPECT_EQ(names, (std::vector<std::string>{"hybmss", "emsm", "msm_18"})) << "msm_18 is valid at 0.25 alone";
}

TEST(ClosestModel, AModelIsNotNamedOffItsOwnPoissonsRatio) {
  const Headline h = headline({with_models("bunny", 0.45, 1e-4, {{"msm_18", 0.01}, {"emsm", 0.03}})});
  EXPECT_EQ(h.answer.find("emsm: its displacements are within 3 %"), 0u) << h.answer;
  EXPECT_NE(h.models[1].sentence.find("; a solid of ν = 0.25 alone, which was not run."), std::string::npos)
      << h.models[1].sentence;
  const Headline own = headline({with_models("bunny", 0.25, 1e-4, {{"msm_18", 0.01}, {"emsm", 0.03}})});
  EXPECT_EQ(own.answer.find("Of the spring models msm_18 comes closest"), 0u) << own.answer;
  const Headline none = headline({with_models("bunny", 0.45, 1e-4, {{"msm_18", 0.01}})});
  EXPECT_EQ(none.answer,
            "No spring model was compared at a Poisson's ratio that it claims: msm_18 (a solid of ν = 0.25 alone).");
}

TEST(ClosestModel, AClassicModelIsJudgedAtItsOwnRatioAmongOthers) {
  CaseResult c = with_models("cube", 0.25, 1e-4, {{"msm_18", 0.01}, {"emsm", 0.03}});
  add_row(c, "msm_18", 0.4, "displacement_error", 0.12, 1e-4);
  add_row(c, "emsm", 0.4, "displacement_error", 0.03, 1e-4);
  const Headline h = headline({c});
  EXPECT_EQ(h.answer.find("Of the spring models emsm comes closest"), 0u)
      << "it was compared more widely: " << h.answer;
  EXPECT_NE(h.models[1].sentence.find("within 12 % of FEM"), std::string::npos);
  EXPECT_NE(h.models[1].sentence.find("; a solid of ν = 0.25 alone, there within 1 %."), std::string::npos)
      << h.models[1].sentence;
}

TEST(ClosestModel, WithinTheReferencesUncertaintyModelsAreNotRanked) {
  const Headline h =
      headline({with_models("shear", 0.3, 0.02, {{"emsm", 0.05}, {"hybmss", 0.04}, {"kirkwood", 0.07}})});
  EXPECT_EQ(h.answer,
            "Of the spring models hybmss (4 %) and emsm (5 %) come closest and cannot be told apart: their largest "
            "errors differ by no more than the "
            "2 % that the reference is uncertain by, at ν = 0.3, in 1 linear case.");
  EXPECT_FALSE(h.doubt);
  EXPECT_EQ(headline({with_models("shear", 0.3, 0.005, {{"emsm", 0.05}, {"hybmss", 0.04}})})
                .answer.find("Of the spring models hybmss comes closest"),
            0u);
}

TEST(ClosestModel, WhatWinsInWholeCubesByTheirPlaceIsNamedWithTheNext) {
  CaseResult rabbit = with_models("rabbit", 0.3, 0.02, {{"emsm", 0.08}, {"hybmss_avg", 0.15}, {"fem_q1", -0.06}});
  rabbit.experiment.body.voxel_counts = {1500};
  rabbit.runs[2].kind = "fem";
  for (std::size_t i = 0; i < 3; ++i) rabbit.runs[i].filled = i == 1 ? 2226 : 1510;  // cut cells: more than cubes
  EXPECT_EQ(
      headline({rabbit}).answer,
      "Of the spring models emsm (8 %) and hybmss_avg (15 %) come closest and cannot be told apart: their largest "
      "errors differ by no more than the 8 % that the reference and the place of whole cubes are uncertain by, at "
      "ν = 0.3, in 1 linear case of 1510 cells.");
  rabbit.runs[0].filled = 2000;
  EXPECT_EQ(headline({rabbit}).answer.find("Of the spring models emsm comes closest"), 0u) << "in cut cells";
}

TEST(ClosestModel, AReferenceUncertainByAFifthDoesNotTell) {
  const auto headline_at = [](double uncertainty, double other) {
    return headline({with_models("lobes", 0.3, uncertainty, {{"emsm", 0.05}, {"hybmss", other}})});
  };
  for (const double other : {0.07, 9.0}) {
    const Headline h = headline_at(2.37, other);
    EXPECT_EQ(h.answer,
              "Which spring model comes closest the reference does not tell, at ν = 0.3, in 1 linear case: it is "
              "uncertain by 237 %. Refine it: in [reference] more cells.");
    EXPECT_TRUE(h.closest.empty());
  }
  EXPECT_EQ(headline_at(0.19, 0.7).answer.find("Of the spring models emsm comes closest: its displacements are within "
                                               "5 % of finite elements, as far as these can tell"),
            0u);
}

TEST(ClosestModel, OfOneModelTheErrorThatTheReferenceLeavesOpenIsNamed) {
  CaseResult bar = with_models("twist", 0.3, 1e-3, {{"hybmss_avg", 0.002}});
  add_row(bar, "hybmss_avg", 0.3, "reaction_error", 1.41, 0.36);
  bar.experiment.body.voxel_counts = {1000};
  const std::string asked = " is uncertain by 36 %. Refine it: in [reference] a smaller edge_m.";
  EXPECT_EQ(headline({bar}).answer,
            "How close hybmss_avg comes the reference does not tell, at ν = 0.3, in 1 linear case: its largest error, "
            "141 % of the reactions of moved supports in twist at ν = 0.3," +
                asked);
  bar.rows.back().of = "force.z_max";
  EXPECT_EQ(headline({bar}).answer,
            "How close hybmss_avg comes the reference does not tell, at ν = 0.3, in 1 linear case: its largest error, "
            "141 % of the force on z_max in twist at ν = 0.3," +
                asked);
}

TEST(ClosestModel, ReactionsOfMovedSupportsCount) {
  CaseResult bar = with_models("bar", 0.3, 1e-4, {{"emsm", 0.0005}, {"hybmss_bt", 0.001}});
  add_row(bar, "emsm", 0.3, "reaction_error", 0.77, 1e-3);
  add_row(bar, "hybmss_bt", 0.3, "reaction_error", 0.18, 1e-3);
  const Headline h = headline({bar});
  EXPECT_EQ(h.answer,
            "Of the spring models hybmss_bt comes closest: its displacements and the reactions of moved supports are "
            "within 18 % of finite elements (uncertain by 0.1 %) at ν = 0.3, in 1 linear case.");
  EXPECT_EQ(
      h.models[1].sentence,
      "displacement within 0.05 % of FEM at ν = 0.3 (worst: bar at ν = 0.3); reactions of moved supports within 77 %.");
}

TEST(ClosestModel, IsRankedAndWordedByWhatWasCompared) {
  CaseResult bar = with_models("bar", 0.3, 1e-4, {{"emsm", 0}, {"hybmss", 0}});
  bar.experiment.measures = {"reaction", "reaction_error"};
  bar.rows.clear();
  add_row(bar, "emsm", 0.3, "reaction_error", 0.054, 1e-3);
  add_row(bar, "hybmss", 0.3, "reaction_error", 0.08, 1e-3);
  const Headline h = headline({bar});
  EXPECT_EQ(
      h.answer,
      "Of the spring models emsm comes closest: its reactions of moved supports are within 5.4 % of finite elements "
      "(uncertain by 0.1 %) at ν = 0.3, in 1 linear case.");
  EXPECT_EQ(h.models[0].sentence, "displacement was not asked for; reactions of moved supports within 5.4 %.");
  bar.rows.back().reference_uncertainty = 0.03;
  EXPECT_NE(headline({bar}).answer.find("their largest errors of reactions of moved supports differ by no more"),
            std::string::npos);
}

// ---- how sure the reference is

TEST(ClosestModel, AReferenceThatDoesNotConvergeIsSaidAfterTheAnswer) {
  CaseResult bunny = with_models("bunny", 0.45, 0.063, {{"emsm", 0.3}, {"hybmss", 0.1}});
  bunny.references[0].converging = false;
  const Headline h = headline({bunny});
  EXPECT_EQ(h.doubt.value().brief,
            "The reference does not converge (bunny at ν = 0.45): its displacement is uncertain by 6.3 %.");
  EXPECT_EQ(terminal_text(h).find("\n" + h.answer + " " + h.doubt->brief + "\n"), 0u) << terminal_text(h);
  bunny.references[0].converging = true;
  const Headline second = headline({with_models("cube", 0.3, 1e-4, {{"emsm", 0.03}}), bunny});
  EXPECT_EQ(second.doubt.value().case_number, 1u);
  EXPECT_EQ(second.doubt->brief,
            "The reference is not sharp (bunny at ν = 0.45): its displacement is uncertain by 6.3 %.");
  bunny.references[0].uncertainty = 0.049;
  EXPECT_FALSE(headline({bunny}).doubt);
}

// ---- linear theory

TEST(ClosestModel, LinearTheoryBeyondFivePerCentOrDegreesIsWarnedOf) {
  CaseResult c = with_models("ear", 0.3, 1e-4, {{"emsm", 0.03}});
  c.deformations = {{0.3, 0.02, 4.9}};
  EXPECT_TRUE(headline({c}).warnings.empty());
  EXPECT_EQ(headline({c}).no_linear_theory, "");
  EXPECT_EQ(headline({c}).deformations.at(0), "ear" + std::string(26, ' ') + "ν = 0.3: 2 %, 4.9°");
  c.deformations = {{0.3, 0, 0}};
  EXPECT_EQ(headline({c}).deformations.at(0), "ear" + std::string(26, ' ') + "ν = 0.3: 0 %, 0°");
  c.deformations = {{0.3, 0.02, 4.9}, {0.4, 0.03, 31}};
  const Warning turned = headline({with_models("cube", 0.3, 1e-4, {{"emsm", 0.03}}), c}).warnings.at(0);
  EXPECT_EQ(turned.case_number, 1u);
  EXPECT_EQ(turned.brief, "ear: rotations of 31° are too large for linear theory (up to 5°)");
  EXPECT_EQ(turned.advice,
            "divide the load by at least 6.2, or set kinematics = \"hencky\" (or another finite-strain law) at the top "
            "of the file");
  EXPECT_EQ(headline({c}).no_linear_theory, "Linear theory does not hold here: ear has rotations of 31°.");
  c.deformations = {{0.3, 0.12, 6}};
  EXPECT_NE(
      terminal_text(headline({c}))
          .find("\nwarning: ear: principal strains of 12 % and rotations of 6° are too large for linear theory (up "
                "to 5 % and 5°); divide the load by at least 2.4, or set"),
      std::string::npos);
  c.experiment.kinematics = "hencky";
  EXPECT_TRUE(headline({c}).warnings.empty());
}

// ---- what is no success

TEST(ClosestModel, ACaseWithoutReferenceIsNoSuccess) {
  CaseResult c = with_models("cube", 0.3, 1e-4, {{"emsm", 0.03}});
  EXPECT_TRUE(success(headline({c})));
  c.experiment.materials.push_back({1e4, 0.4, 1000});
  c.runs.push_back({{"fem_p2", 0.4, {812, 0, 0}}, "fem", "linear", false, "out of memory", "", 0, 0, 0, 0});
  const Headline h = headline({c});
  EXPECT_FALSE(success(h));
  EXPECT_EQ(h.failures, std::vector<std::string>{"cube at ν = 0.4: there is no reference: out of memory"});
}

TEST(ClosestModel, ACaseWhoseModelsAllFailIsNoSuccess) {
  CaseResult c = with_models("cube", 0.3, 1e-4, {{"emsm", 0.03}, {"hybmss", 0.1}});
  c.rows.clear();
  c.runs[0].ok = false;
  const Headline half = headline({c});
  EXPECT_EQ(
      half.failures,
      std::vector<std::string>{
          "cube: nothing was compared: no measure of a model has a reference, an expectation or a published value"})
      << "one ran, without rows";
  c.runs[1].ok = false;
  EXPECT_EQ(headline({c}).failures, std::vector<std::string>{"cube: no model has a result"});
  EXPECT_FALSE(success(headline({c})));
}

TEST(ClosestModel, NothingComparedIsNoSuccess) {
  CaseResult c = with_models("cube", 0.3, 1e-4, {{"emsm", 0.03}});
  c.experiment.reference.elements.clear();
  c.references.clear();
  c.rows.clear();
  const Headline h = headline({c});
  ASSERT_EQ(h.failures.size(), 1u);
  EXPECT_EQ(h.failures[0].find("cube: nothing was compared or measured: the case asks for no reference"), 0u)
      << h.failures[0];
  EXPECT_NE(terminal_text(h).find("FAILED: cube: nothing was compared"), std::string::npos);
  c.published.push_back({{"emsm", 0.3, {1, 1, 1}}, "moduli.poisson_ratio", "1", 0.3, 0.31, "Fig. 1", ""});
  EXPECT_TRUE(success(headline({c})));
}

TEST(ClosestModel, MeasuresAloneAreShownAndNoFailure) {
  CaseResult c = with_models("cube", 0.3, 1e-4, {{"emsm", 0.03}});
  c.experiment.reference.elements.clear();
  c.references.clear();
  c.rows = {{{"emsm", 0.3, {10, 10, 10}}, "cube", "linear", "force.z_max.z", -12.5, "N", {}, {}, {}}};
  const Headline h = headline({c});
  EXPECT_TRUE(success(h));
  ASSERT_EQ(h.measured.size(), 1u);
  EXPECT_NE(terminal_text(h).find("emsm at ν = 0.3 "), std::string::npos);
  EXPECT_NE(terminal_text(h).find("force.z_max.z                             −12.5 N\n"), std::string::npos)
      << terminal_text(h);
}

TEST(ClosestModel, AReferenceAtRestComparesNothing) {
  CaseResult c = with_models("cube", 0.3, std::nan(""), {{"emsm", std::nan("")}});
  add_row(c, "emsm", 0.3, "volume_change", 0, 0);
  c.deformations = {{0.3, 0, 0}};
  const Headline h = headline({c});
  EXPECT_FALSE(success(h));
  EXPECT_EQ(h.failures,
            std::vector<std::string>{"cube: nothing was compared, since nothing moves in the reference: every load is "
                                     "zero, or acts where the body is held"});
  c.deformations = {{0.3, 1e-3, 0}};
  EXPECT_TRUE(success(headline({c})));
}

}  // namespace
}  // namespace springproof::closest_model_test
