// Which model the headline names, how sure of the reference it is, and what is no success.
#include <gtest/gtest.h>

#include <cmath>

#include "unit/comparisons/report/headline_cases.h"

namespace springproof::closest_model_test {
namespace {

using Json = nlohmann::json;
using namespace test;

// ---- which model comes closest

TEST(ClosestModel, OfABodyOfVoxelsTheSpringsOwnPartDecides) {
  CaseResult bunny = with_models("bunny", 0.45, 0.01, {{"emsm", 0.059}, {"hybmss_bt", 0.17}});
  add_split(bunny, "emsm", 0.45, 0.059, 0.178);
  add_split(bunny, "hybmss_bt", 0.45, 0.17, 0.016);
  add_row(bunny, "emsm", 0.45, "promised_error", 0.08, 0);
  const Headline h = headline_of({bunny});
  EXPECT_EQ(h.answer.find("Of the spring models hybmss_bt comes closest: its springs stay within 1.6 % of finite "
                          "elements on the same cubes, its displacements, coarse cells included, within 17 % of "),
            0u)
      << h.answer;
  EXPECT_NE(h.models[0].sentence.find("; its springs within 18 % of FEM on the same cubes; its cells promise 8 %."),
            std::string::npos)
      << h.models[0].sentence;
}

TEST(ClosestModel, WhatHasNoSpringsOfItsOwnIsNotRankedBesideTheOthersSprings) {
  CaseResult ball =
      with_models("ball", 0.3, 0.0062, {{"hybmss", 0.014}, {"hybmss_avg", 0.013}, {"extrapolated", 0.0067}});
  add_split(ball, "hybmss", 0.3, 0.014, 0.006);
  add_split(ball, "hybmss_avg", 0.3, 0.013, 0.0027);
  EXPECT_EQ(headline_of({ball}).answer,
            "Of the spring models hybmss_avg (0.27 %, 1.3 % with coarse cells) and hybmss (0.6 %, 1.4 % with coarse "
            "cells) come closest and cannot be told apart: their largest errors, on bodies that are no blocks those of "
            "their springs alone, differ by no more than the 0.62 % that the reference is uncertain by, at ν = 0.3, in "
            "1 linear case.");
}

// Macro-cells have no whole cubes to compare with.
TEST(ClosestModel, BesideAModelWithoutPartsTheWholeErrorsDecide) {
  CaseResult bar =
      with_models("bar", 0.3, 0.001, {{"hybmss_macro", 0.008}, {"hybmss_avg", 0.013}, {"extrapolated", 0.002}});
  add_split(bar, "hybmss_avg", 0.3, 0.013, 0.0027);
  const Headline h = headline_of({bar});
  EXPECT_EQ(h.answer.find("Of the spring models hybmss_macro comes closest: its displacements stay within 0.8 % of"),
            0u)
      << h.answer;
  EXPECT_NE(h.models[1].sentence.find("its springs within 0.27 %"), std::string::npos) << h.models[1].sentence;
}

TEST(ClosestModel, BlocksAndBodiesOfVoxelsShareOneNumber) {
  CaseResult bunny = with_models("bunny", 0.45, 1e-3, {{"emsm", 0.059}, {"hybmss_bt", 0.17}});
  add_split(bunny, "emsm", 0.45, 0.059, 0.178);
  add_split(bunny, "hybmss_bt", 0.45, 0.17, 0.016);
  CaseResult bar = with_models("bar", 0.45, 1e-3, {{"emsm", 0.01}, {"hybmss_bt", 0.012}});
  add_row(bar, "hybmss_bt", 0.45, "reaction_error", 0.019, 1e-3);
  EXPECT_EQ(headline_of({bunny, bar}).answer,
            "Of the spring models hybmss_bt comes closest: its displacements and the reactions of moved supports stay "
            "within 1.9 % of finite elements, counting on bodies that are no blocks its springs alone (17 % with the "
            "coarse cells), at ν = 0.45, in 2 linear cases.");
}

TEST(ClosestModel, AModelIsNotNamedOffItsOwnPoissonsRatio) {
  const Headline h = headline_of({with_models("bunny", 0.45, 1e-4, {{"msm_18", 0.01}, {"emsm", 0.03}})});
  EXPECT_EQ(h.answer.find("Of the spring models emsm comes closest"), 0u) << h.answer;
  EXPECT_NE(h.models[0].sentence.find("; a solid of ν = 0.25 alone, which was not run."), std::string::npos)
      << h.models[0].sentence;
  const Headline own = headline_of({with_models("bunny", 0.25, 1e-4, {{"msm_18", 0.01}, {"emsm", 0.03}})});
  EXPECT_EQ(own.answer.find("Of the spring models msm_18 comes closest"), 0u) << own.answer;
  const Headline none = headline_of({with_models("bunny", 0.45, 1e-4, {{"msm_18", 0.01}})});
  EXPECT_EQ(none.answer,
            "No spring model was compared at a Poisson's ratio that it claims: msm_18 (a solid of ν = 0.25 alone).");
}

TEST(ClosestModel, AClassicModelIsJudgedAtItsOwnRatioAmongOthers) {
  CaseResult c = with_models("cube", 0.25, 1e-4, {{"msm_18", 0.01}, {"emsm", 0.03}});
  add_row(c, "msm_18", 0.4, "displacement_error", 0.12, 1e-4);
  add_row(c, "emsm", 0.4, "displacement_error", 0.03, 1e-4);
  const Headline h = headline_of({c});
  EXPECT_EQ(h.answer.find("Of the spring models emsm comes closest"), 0u)
      << "it was compared more widely: " << h.answer;
  EXPECT_NE(h.models[0].sentence.find("within 12 % of FEM"), std::string::npos);
  EXPECT_NE(h.models[0].sentence.find("; a solid of ν = 0.25 alone, there within 1 %."), std::string::npos)
      << h.models[0].sentence;
}

TEST(ClosestModel, WithinTheReferencesUncertaintyModelsAreNotRanked) {
  const Headline h =
      headline_of({with_models("shear", 0.3, 0.02, {{"emsm", 0.05}, {"hybmss", 0.04}, {"kirkwood", 0.07}})});
  EXPECT_EQ(h.answer,
            "Of the spring models hybmss (4 %) and emsm (5 %) come closest and cannot be told apart: their largest "
            "errors differ by no more than the "
            "2 % that the reference is uncertain by, at ν = 0.3, in 1 linear case.");
  EXPECT_FALSE(h.doubt);
  EXPECT_EQ(headline_of({with_models("shear", 0.3, 0.005, {{"emsm", 0.05}, {"hybmss", 0.04}})})
                .answer.find("Of the spring models hybmss comes closest"),
            0u);
}

TEST(ClosestModel, AReferenceUncertainByAFifthDoesNotTell) {
  const auto headline_at = [](double uncertainty, double other) {
    return headline_of({with_models("lobes", 0.3, uncertainty, {{"emsm", 0.05}, {"hybmss", other}})});
  };
  for (const double other : {0.07, 9.0}) {
    const Headline h = headline_at(2.37, other);
    EXPECT_EQ(h.answer,
              "Which spring model comes closest the reference does not tell, at ν = 0.3, in 1 linear case: it is "
              "uncertain by 237 %. Refine it: in [reference] more cells.");
    EXPECT_TRUE(h.closest.empty());
  }
  EXPECT_EQ(headline_at(0.19, 0.7).answer.find("Of the spring models emsm comes closest"), 0u);
}

TEST(ClosestModel, OfOneModelTheErrorThatTheReferenceLeavesOpenIsNamed) {
  CaseResult bar = with_models("twist", 0.3, 1e-3, {{"hybmss_avg", 0.002}});
  add_row(bar, "hybmss_avg", 0.3, "reaction_error", 1.41, 0.36);
  bar.experiment.body.voxel_counts = {1000};
  const std::string asked = " is uncertain by 36 %. Refine it: in [reference] a smaller edge_m.";
  EXPECT_EQ(headline_of({bar}).answer,
            "How close hybmss_avg comes the reference does not tell, at ν = 0.3, in 1 linear case: its largest error, "
            "141 % of the reactions of moved supports in twist at ν = 0.3," +
                asked);
  for (const auto& [what, reference, off] : {std::tuple("force.z_max", 1.03, 1.4523), {"torque.z_max", 2.84, 0.19}})
    for (const char* component : {"x", "y", "z", "magnitude"}) {
      const bool along = component == std::string("x") || component == std::string("y");
      bar.rows.push_back({{"hybmss_avg", 0.3, {10, 10, 10}},
                          "twist",
                          "linear",
                          std::string(what) + "." + component,
                          along ? 0 : reference + off,
                          "N",
                          along ? 0 : reference,
                          0.1,
                          along ? 0 : off});
    }
  EXPECT_EQ(headline_of({bar}).answer,
            "How close hybmss_avg comes the reference does not tell, at ν = 0.3, in 1 linear case: its largest error, "
            "141 % of the force on z_max in twist at ν = 0.3," +
                asked);
}

TEST(ClosestModel, ReactionsOfMovedSupportsCount) {
  CaseResult bar = with_models("bar", 0.3, 1e-4, {{"emsm", 0.0005}, {"hybmss_bt", 0.001}});
  add_row(bar, "emsm", 0.3, "reaction_error", 0.77, 1e-3);
  add_row(bar, "hybmss_bt", 0.3, "reaction_error", 0.18, 1e-3);
  const Headline h = headline_of({bar});
  EXPECT_EQ(h.answer,
            "Of the spring models hybmss_bt comes closest: its displacements and the reactions of moved supports stay "
            "within 18 % of finite elements at ν = 0.3, in 1 linear case.");
  EXPECT_EQ(
      h.models[0].sentence,
      "displacement within 0.05 % of FEM at ν = 0.3 (worst: bar at ν = 0.3); reactions of moved supports within 77 %.");
}

TEST(ClosestModel, IsRankedAndWordedByWhatWasCompared) {
  CaseResult bar = with_models("bar", 0.3, 1e-4, {{"emsm", 0}, {"hybmss", 0}});
  bar.experiment.measures = {"reaction", "reaction_error"};
  bar.rows.clear();
  add_row(bar, "emsm", 0.3, "reaction_error", 0.054, 1e-3);
  add_row(bar, "hybmss", 0.3, "reaction_error", 0.08, 1e-3);
  const Headline h = headline_of({bar});
  EXPECT_EQ(h.answer,
            "Of the spring models emsm comes closest: its reactions of moved supports stay within 5.4 % of finite "
            "elements at ν = 0.3, in 1 linear case.");
  EXPECT_EQ(h.models[0].sentence, "displacement was not asked for; reactions of moved supports within 5.4 %.");
  bar.rows.back().reference_uncertainty = 0.03;
  EXPECT_NE(headline_of({bar}).answer.find("their largest errors of reactions of moved supports differ by no more"),
            std::string::npos);
  bar.splits.push_back({{"emsm", 0.3, {10, 10, 10}}, 0.01, "reaction_error", "1", 0.054, 0.01, 0, 0, 0, 0});
  bar.splits.push_back({{"hybmss", 0.3, {10, 10, 10}}, 0.01, "reaction_error", "1", 0.08, 0.06, 0, 0, 0, 0});
  EXPECT_NE(
      headline_of({bar}).answer.find("its reactions of moved supports, coarse cells included, within 5.4 % of the "
                                     "reference"),
      std::string::npos)
      << headline_of({bar}).answer;
}

// ---- how sure the reference is

TEST(ClosestModel, AReferenceUncertainByHalfOfTheErrorIsSaidToBe) {
  EXPECT_EQ(
      headline_of({with_models("base", 0.3, 0.024, {{"hybmss_avg", 0.025}})}).answer,
      "Of the spring models hybmss_avg comes closest: its displacements stay within 2.5 % of finite elements at ν "
      "= 0.3, in 1 linear case; the reference itself is uncertain by 2.4 %.");
  EXPECT_EQ(headline_of({with_models("base", 0.3, 0.012, {{"hybmss_avg", 0.025}})}).answer.find("uncertain"),
            std::string::npos);
}

TEST(ClosestModel, AReferenceThatDoesNotConvergeIsSaidAfterTheAnswer) {
  CaseResult bunny = with_models("bunny", 0.45, 0.063, {{"emsm", 0.3}, {"hybmss", 0.1}});
  bunny.references[0].note = "not converging: finest grid, largest difference";
  bunny.references[0].observed_order.reset();
  const Headline h = headline_of({bunny});
  EXPECT_EQ(h.doubt.value().brief,
            "The reference does not converge (bunny at ν = 0.45): its displacement is uncertain by 6.3 %.");
  EXPECT_EQ(terminal_text(h).find("\n" + h.answer + " " + h.doubt->brief + "\n"), 0u) << terminal_text(h);
  bunny.references[0].note = "Richardson, GCI";
  const Headline second = headline_of({with_models("cube", 0.3, 1e-4, {{"emsm", 0.03}}), bunny});
  EXPECT_EQ(second.doubt.value().case_number, 1u);
  EXPECT_EQ(second.doubt->brief,
            "The reference is not sharp (bunny at ν = 0.45): its displacement is uncertain by 6.3 %.");
  bunny.references[0].uncertainty = 0.049;
  EXPECT_FALSE(headline_of({bunny}).doubt);
}

// ---- linear theory

TEST(ClosestModel, LinearTheoryBeyondFivePerCentOrDegreesIsWarnedOf) {
  CaseResult c = with_models("ear", 0.3, 1e-4, {{"emsm", 0.03}});
  c.deformations = {{0.3, 0.02, 4.9}};
  EXPECT_TRUE(headline_of({c}).warnings.empty());
  EXPECT_EQ(headline_of({c}).deformations.at(0), "ear" + std::string(26, ' ') + "ν = 0.3: 2 %, 4.9°");
  c.deformations = {{0.3, 0, 0}};
  EXPECT_EQ(headline_of({c}).deformations.at(0), "ear" + std::string(26, ' ') + "ν = 0.3: 0 %, 0°");
  c.deformations = {{0.3, 0.02, 4.9}, {0.4, 0.03, 31}};
  const Warning turned = headline_of({with_models("cube", 0.3, 1e-4, {{"emsm", 0.03}}), c}).warnings.at(0);
  EXPECT_EQ(turned.case_number, 1u);
  EXPECT_EQ(turned.brief, "ear: rotations of 31° are too large for linear theory (up to 5°)");
  EXPECT_EQ(turned.advice,
            "divide the load by at least 6.2, or set kinematics = \"hencky\" (or another finite-strain law)");
  c.deformations = {{0.3, 0.12, 6}};
  EXPECT_NE(
      terminal_text(headline_of({c}))
          .find("\nwarning: ear: principal strains of 12 % and rotations of 6° are too large for linear theory (up "
                "to 5 % and 5°); divide the load by at least 2.4, or set"),
      std::string::npos);
  c.experiment.kinematics = "hencky";
  EXPECT_TRUE(headline_of({c}).warnings.empty());
}

// ---- what is no success

TEST(ClosestModel, ACaseWithoutReferenceIsNoSuccess) {
  CaseResult c = with_models("cube", 0.3, 1e-4, {{"emsm", 0.03}});
  EXPECT_TRUE(success(headline_of({c})));
  c.experiment.materials.push_back({1e4, 0.4, 1000});
  c.runs.push_back({{"fem_p2", 0.4, {812, 0, 0}}, "fem", "linear", false, "out of memory", "", 0, 0, 0, 0});
  const Headline h = headline_of({c});
  EXPECT_FALSE(success(h));
  EXPECT_EQ(h.failures, std::vector<std::string>{"cube at ν = 0.4: there is no reference: out of memory"});
}

TEST(ClosestModel, ACaseWhoseModelsAllFailIsNoSuccess) {
  CaseResult c = with_models("cube", 0.3, 1e-4, {{"emsm", 0.03}, {"hybmss", 0.1}});
  c.rows.clear();
  c.runs[0].ok = false;
  const Headline half = headline_of({c});
  EXPECT_EQ(
      half.failures,
      std::vector<std::string>{
          "cube: nothing was compared: no measure of a model has a reference, an expectation or a published value"})
      << "one ran, without rows";
  c.runs[1].ok = false;
  EXPECT_EQ(headline_of({c}).failures, std::vector<std::string>{"cube: no model has a result"});
  EXPECT_FALSE(success(headline_of({c})));
}

TEST(ClosestModel, NothingComparedIsNoSuccess) {
  CaseResult c = with_models("cube", 0.3, 1e-4, {{"emsm", 0.03}});
  c.experiment.reference.elements.clear();
  c.references.clear();
  c.rows.clear();
  const Headline h = headline_of({c});
  ASSERT_EQ(h.failures.size(), 1u);
  EXPECT_EQ(h.failures[0].find("cube: nothing was compared, since the case asks for no reference"), 0u)
      << h.failures[0];
  EXPECT_NE(terminal_text(h).find("FAILED: cube: nothing was compared"), std::string::npos);
  c.published.push_back({{"emsm", 0.3, {1, 1, 1}}, "moduli.poisson_ratio", "1", 0.3, 0.31, "Fig. 1", ""});
  EXPECT_TRUE(success(headline_of({c})));
}

TEST(ClosestModel, AReferenceAtRestComparesNothing) {
  CaseResult c = with_models("cube", 0.3, std::nan(""), {{"emsm", std::nan("")}});
  add_row(c, "emsm", 0.3, "volume_change", 0, 0);
  c.deformations = {{0.3, 0, 0}};
  const Headline h = headline_of({c});
  EXPECT_FALSE(success(h));
  EXPECT_EQ(h.failures,
            std::vector<std::string>{"cube: nothing was compared, since nothing moves in the reference: every load is "
                                     "zero, or acts where the body is held"});
  c.deformations = {{0.3, 1e-3, 0}};
  EXPECT_TRUE(success(headline_of({c})));
}

}  // namespace
}  // namespace springproof::closest_model_test
