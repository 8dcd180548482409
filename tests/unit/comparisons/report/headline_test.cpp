#include "comparisons/report/headline.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "comparisons/report/headline_cases.h"
#include "unit/comparisons/report/headline_cases.h"

namespace springproof::headline_test {
namespace {

using Json = nlohmann::json;
using namespace test;

TEST(Headline, TakesTheWorstOfAllCasesAtTheFinestCells) {
  const Headline h = headline({with_errors("shear", "hybmss", {{0, 10, 0.5}, {0, 20, 0.002}, {0.4, 20, 0.003}}),
                               with_errors("torsion", "hybmss", {{0, 20, 0.001}, {0.4, 20, 0.0082}})});
  ASSERT_EQ(h.models.size(), 1u);
  EXPECT_EQ(h.models[0].sentence, "displacement within 0.82 % of FEM for ν from 0 to 0.4 (worst: torsion at ν = 0.4).");
  EXPECT_EQ(
      h.answer,
      "hybmss: its displacements are within 0.82 % of finite elements (uncertain by 0.01 %) for ν from 0 to 0.4, in "
      "2 linear cases.");
}

TEST(Headline, NamesTheModelsClosestInTime) {
  CaseResult c;
  c.experiment.name = "bar";
  c.experiment.kinematics = "hencky";
  for (const auto& [model, error] : {std::pair("hybmss", 0.2), {"hybmss_avg", 0.06}, {"emsm", 0.08}}) {
    const std::string label = std::string(model) + " in motion";
    c.experiment.models.push_back({model, {}, label, {}, {}, true});
    for (const double nu : {0.0, 0.3}) {
      const double there = nu > 0 ? error : error / 2;
      c.rows.push_back({{label, nu, {4, 4, 4}}, "bar", "finite", "motion_error", there, "1", 0, 0.03, there});
    }
  }
  const std::string found =
      "In time hybmss_avg (6 %) and emsm (8 %) come closest to finite elements and cannot be told apart, by the "
      "probes' "
      "difference over the whole motion for ν from 0 to 0.3; these are uncertain by 3 %.";
  EXPECT_EQ(headline({c}).answer, found);
  EXPECT_EQ(headline({c}).closest, (std::vector<std::string>{"hybmss_avg in motion", "emsm in motion"}));
  c.rows.push_back({{"msm_18 in motion", 0.3, {4, 4, 4}}, "bar", "finite", "motion_error", 0.01, "1", 0, 0.03, 0.01});
  EXPECT_EQ(headline({c}).answer, found);  // compared at one Poisson's ratio only
}

TEST(Headline, AMotionHasAFirstSentence) {
  CaseResult c = with_errors("fall", "hybmss_avg in motion", {});
  c.experiment.kinematics = "hencky";
  c.experiment.models = {{"hybmss_avg", {}, "hybmss_avg in motion", {}, {}, true}};
  c.runs.push_back({{"hybmss_avg in motion", 0.3, {4, 4, 4}}, "msm", "finite", true, "", "explicit", 0, 0, 4.0, 375});
  HistoryRecord& h = c.histories.emplace_back();
  static_cast<RunKey&>(h) = {"hybmss_avg in motion", 0.3, {4, 4, 4}};
  h.time_step = 5e-5;
  h.time = {0, 0.25, 0.5};
  h.measured = {{"energy_drift", 1.2e-5}, {"momentum_drift", 3e-14}};
  EXPECT_EQ(headline({c}).answer,
            "Over 0.5 s of fall, in 10000 steps, hybmss_avg in motion keeps its energy within 1.2e-05 and its momentum "
            "within 3.0e-14, at 0.4 ms of computing a step, 8 s for each second of the motion.");
  h.measured.clear();
  EXPECT_EQ(headline({c}).answer,
            "Over 0.5 s of fall, in 10000 steps, hybmss_avg in motion takes 0.4 ms of computing a step, 8 s for each "
            "second of the motion.");
}

TEST(Headline, AuxeticSolidsAreNamedApartWhereThereAreOthers) {
  const std::vector<CaseResult> cases = {with_errors("shear", "hybmss", {{-0.5, 10, 0.3}, {0, 10, 0.02}}),
                                         with_errors("shear", "emsm", {{-0.5, 10, 0.1}, {0, 10, 0.05}})};
  const Headline h = headline(cases);
  EXPECT_EQ(
      h.answer,
      "Of the spring models hybmss comes closest: its displacements are within 2 % of finite elements (uncertain by "
      "0.01 %) at ν = 0, in 1 linear case; left out here: 30 % at ν = −0.5.");
  EXPECT_EQ(h.closest, std::vector<std::string>{"hybmss"});
  const Headline alone = headline({with_errors("shear", "hybmss", {{-0.5, 10, 0.3}})});
  EXPECT_NE(alone.answer.find("within 30 % of finite elements (uncertain by 0.01 %) at ν = −0.5, in"),
            std::string::npos)
      << alone.answer;
}

TEST(Headline, TetrahedraAndLongPoissonsRatiosAreReadable) {
  CaseResult c = with_errors("hand", "hybmss", {{0.4999750012499375, 10, 0.5}});
  c.runs[0].ok = false;
  c.runs[0].cells = {812, 0, 0};
  c.rows[0].cells = {812, 0, 0};
  c.rows.push_back(
      {{"hybmss", 0.4999750012499375, {100, 0, 0}}, "hand", "linear", "displacement_error", 0.7, "1", {}, 1e-4, 0.7});
  const Headline h = headline({c});
  EXPECT_EQ(h.failed_runs.at(0), "hand: hybmss at ν = 0.499975, 812 tets: no reason given");
  EXPECT_EQ(h.models[0].sentence, "displacement within 50 % of FEM at ν = 0.499975 (worst: hand at ν = 0.499975).")
      << "the finer mesh counts";
}

TEST(Headline, ACaseWithoutModelsIsJudgedByItsExpectationsAlone) {
  CaseResult c = with_errors("plate", "fem_p1", {{0, 10, 0.5}});
  c.experiment.models.clear();
  const RunKey at{"fem_p1", 0, {10, 10, 10}};
  c.checks.push_back({at, "displacement_error_order", "1", "analytic", 1.9, 1.2, 0, 0.0, Verdict::fail, "", true});
  const Headline h = headline({c});
  EXPECT_TRUE(h.models.empty());
  ASSERT_EQ(h.failed_checks.size(), 1u);
  EXPECT_NE(h.failed_checks[0].find("computed 1.2, expected at least 1.9"), std::string::npos) << h.failed_checks[0];
}

TEST(Headline, SaysWhereATighterBoundHolds) {
  const Headline h = headline({with_errors(
      "shear", "msm", {{-0.2, 10, 0.2}, {0.2, 10, 0.009}, {0.25, 10, 0.001}, {0.3, 10, 0.011}, {0.4, 10, 0.01}})});
  EXPECT_EQ(h.models[0].sentence,
            "displacement within 20 % of FEM for ν from −0.2 to 0.4 (worst: shear at ν = −0.2); within 1 % "
            "for ν from "
            "0.2 to 0.25 and at ν = 0.4.");
}

TEST(Headline, SaysWhenTheErrorIsBelowTheUncertainty) {
  const Headline h = headline({with_errors("shear", "hybmss", {{0.25, 10, 5e-5}})});
  EXPECT_EQ(h.models[0].sentence,
            "displacement within 0.005 % of FEM at ν = 0.25 (worst: shear at ν = 0.25, below the 0.01 % "
            "uncertainty of "
            "the reference).");
}

TEST(Headline, AModelThatRanInFewerCasesIsNotTheClosest) {
  const Headline h =
      headline({with_errors("shear", "emsm", {{0, 10, 0.02}}), with_errors("torsion", "emsm", {{0, 10, 0.02}}),
                with_errors("shear", "lucky", {{0, 10, 1e-3}})});
  EXPECT_EQ(h.answer.find("Of the spring models emsm comes closest"), 0u) << h.answer;
  EXPECT_EQ(h.models.at(0).model, "emsm");
}

TEST(Headline, FiniteElementsAreComparedButNeverTheClosest) {
  CaseResult fem = with_errors("shear", "fem_q1", {{0, 10, 1e-3}});
  fem.runs[0].kind = "fem";
  const Headline h = headline({fem, with_errors("shear", "emsm", {{0, 10, 0.02}})});
  ASSERT_EQ(h.models.size(), 2u);
  EXPECT_EQ(h.models[0].model, "emsm");
  EXPECT_TRUE(h.models[1].beside);
  EXPECT_EQ(h.answer.find("emsm: its displacements are within 2 %"), 0u) << h.answer;
}

TEST(Headline, LargeDeformationIsKeptApart) {
  CaseResult large = with_errors("torsion_45", "hybmss", {{0, 10, 0.3}});
  large.experiment.kinematics = "hencky";
  const Headline h = headline({large, with_errors("shear", "hybmss", {{0, 10, 0.002}})});
  ASSERT_EQ(h.models.size(), 2u);
  EXPECT_FALSE(h.models[0].large_deformation);
  EXPECT_NE(h.models[0].sentence.find("within 0.2 %"), std::string::npos);
  EXPECT_TRUE(h.models[1].large_deformation);
  EXPECT_NE(h.models[1].sentence.find("within 30 %"), std::string::npos);
  EXPECT_EQ(
      headline({large}).answer,
      "hybmss: its displacements are within 30 % of finite elements (uncertain by 0.01 %) at ν = 0, in 1 case of large "
      "deformation.");
}

TEST(Headline, VolumeIsToldInPercentagePoints) {
  CaseResult c = with_errors("shear", "hybmss", {{0, 10, 0.002}});
  c.rows.push_back({{"hybmss", 0, {10, 10, 10}}, "shear", "linear", "volume_change", 0.05, "1", 0.0507, 1e-5, -0.0007});
  EXPECT_NE(headline({c}).models[0].sentence.find("; volume change within 0.07 percentage points."), std::string::npos);
}

TEST(Headline, CountsExpectationsAndListsWhatWentWrong) {
  const Headline h = headline({sample_case()});
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
  const Headline h = headline({sample_case()});
  ASSERT_EQ(h.models.size(), 2u);
  EXPECT_EQ(h.models[1].model, "emsm");
  EXPECT_EQ(h.models[1].sentence, "no displacement could be compared.");
}

// ---- the terminal

TEST(Headline, TheTerminalHasATableOfAHundredColumns) {
  CaseResult large = with_errors("torsion_45", "hybmss", {{0, 10, 0.3}});
  large.experiment.kinematics = "hencky";
  CaseResult linear = with_errors("shear", "hybmss", {{0, 10, 0.002}});
  linear.runs.push_back({{"fem_q1", 0, {10, 10, 10}}, "fem", "linear", true, "", "", 1, 0, 0, 0});
  add_row(linear, "fem_q1", 0, "displacement_error", 0.001, 1e-4);
  for (auto& run : linear.runs) run.filled = 1000;
  linear.runs.front().seconds = 0.123;
  linear.experiment.models.push_back({"msm_18", {}, "a label of more than twenty-two letters", {}});
  add_row(linear, "a label of more than twenty-two letters", 0, "displacement_error", 0.05, 1e-4);
  add_row(linear, "a label of more than twenty-two letters", 0, "reaction_error", 0.04, 1e-4);
  const Headline h = headline({large, linear});
  const std::string text = terminal_text(h);
  EXPECT_EQ(
      text,
      "\nOf the spring models hybmss comes closest: its displacements are within 0.2 % of finite elements "
      "(uncertain by 0.01 %) at ν = 0, in 1 linear case of 1000 cells.\n\n" +
          std::string(linear_title) +
          "\n"
          "  model                          error in                        reaction  volume       cells   solve\n"
          "  hybmss                  0.2 ± 0.01 % shear at ν = 0                   –       –        1000  0.12 s\n"
          "  a label of more than …    5 ± 0.01 % shear at ν = 0                 4 %       –                   –\n"
          "  for comparison\n"
          "  fem_q1                  0.1 ± 0.01 % shear at ν = 0                   –       –        1000       –\n"
          "\n" +
          std::string(large_title) +
          "\n"
          "  model                          error in                        reaction  volume       cells   solve\n"
          "  hybmss                   30 ± 0.01 % torsion_45 at ν = 0              –       –                   –\n"
          "\nNo expectations are stated.\n");
  EXPECT_EQ(text.find("displacement within"), std::string::npos);
  EXPECT_NE(terminal_text(h, true).find("hybmss: displacement within 0.2 % of FEM"), std::string::npos);
}

TEST(Headline, VerificationShowsValueTargetAndError) {
  CaseResult c = with_errors("membrane", "fem_q2", {{0.3, 10, 0.5}});
  c.experiment.models.clear();
  c.experiment.reference.elements = {"q2"};
  c.experiment.materials = {{1e4, 0.3, 1000}};
  c.references.push_back({0.3, "displacement.C.y", "m", {}, {}, 1.5, 16.455, 0.018, "", "q2"});
  const RunKey at{"fem", 0.3, {10, 10, 10}};
  c.checks.push_back(
      {at, "displacement.C.y", "m", "published", 16.433, 16.455, 0.05, 0.018, Verdict::pass, "Table 1", false});
  const Headline h = headline({c});
  ASSERT_EQ(h.verification.size(), 1u);
  for (const char* part :
       {"membrane ", "fem, displacement.C.y at ν = 0.3", "16.455 ± 0.018 m", "target 16.433", "+0.13 %", "pass"})
    EXPECT_NE(h.verification[0].find(part), std::string::npos) << part << " in " << h.verification[0];
  EXPECT_NE(terminal_text(h).find(h.verification[0]), std::string::npos);
  EXPECT_TRUE(success(h));
}

TEST(Headline, NothingRunIsNothingSaid) {
  const Headline h = headline({});
  EXPECT_TRUE(h.models.empty());
  EXPECT_EQ(h.answer, "");
  EXPECT_EQ(expectations_sentence(h), "No expectations are stated.");
}

TEST(Headline, APressureAtLargeStrainIsSaidToBeADeadLoad) {
  CaseResult c = with_errors("tube", "hybmss", {{0.3, 8, 0.1}});
  c.experiment.loads = {Pressure{"inner", 120}};
  EXPECT_TRUE(headline({c}).notes.empty());
  c.experiment.kinematics = "neo_hooke";
  const Headline h = headline({with_errors("bar", "hybmss", {{0.3, 8, 0.1}}), c});
  ASSERT_EQ(h.notes.size(), 1u);
  EXPECT_EQ(h.notes[0].case_number, 1u);
  EXPECT_NE(
      terminal_text(h).find("\nnote: tube: pressure_Pa is a dead load, per area at rest and against the normals at "
                            "rest; a pressure that follows"),
      std::string::npos)
      << terminal_text(h);
}

TEST(Headline, DampingInProportionToTheMassIsSaidToBrakeAFreeBody) {
  CaseResult c = with_errors("ball", "hybmss", {{0.3, 8, 0.1}});
  c.experiment.kinematics = "hencky";
  c.experiment.dynamics = MotionChoice();
  c.experiment.dynamics->viscosity = 1e-4;
  EXPECT_TRUE(headline({c}).notes.empty());
  c.experiment.dynamics->damping = 50;
  EXPECT_EQ(headline({c}).notes.at(0).text(),
            "ball: damping in proportion to the mass (loss_factor, damping_1_s) also brakes what the free body does as "
            "a whole, its fall and its turning, at a rate of 50/s; viscosity_s alone does not");
  c.experiment.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}}};
  EXPECT_TRUE(headline({c}).notes.empty());
}

TEST(Headline, ModelsThatFollowAnotherLawThanTheReferenceAreNamed) {
  CaseResult c = with_models("bar", 0.3, 1e-4, {{"hybmss", 0.03}, {"hybmss_avg", 0.02}});
  c.experiment.kinematics = "hencky";
  c.laws = {{"hybmss_avg", "hencky"}};
  EXPECT_TRUE(headline({c}).notes.empty());
  c.experiment.kinematics = "log_cauchy";
  EXPECT_EQ(headline({c}).notes.at(0).text(),
            "bar: hybmss_avg follows the law \"hencky\", the reference \"log_cauchy\": what these differ by at large "
            "strain counts among the errors");
  EXPECT_EQ(to_json(c)["experiment"]["models"][1]["law"], "hencky");
  EXPECT_TRUE(to_json(c)["experiment"]["models"][0]["law"].is_null());
}

Run lattice_run(const std::string& model, double nu, const char* kinematics, const Stability& state) {
  const RunKey key{model, nu, {6, 6, 6}};
  return {key, "msm", kinematics, state.lost.empty(), "", "", 1, 0, 0, 0, 0, 0, state};
}

TEST(Headline, ALostEquilibriumIsToldWithWhatHappenedAndWhatHolds) {
  CaseResult c = with_errors("press", "hybmss_fd", {});
  c.experiment.kinematics = "hencky";
  const auto run = [&](const std::string& model, double nu, const Stability& state) {
    c.runs.push_back(lattice_run(model, nu, "finite", state));
  };
  run("hybmss_fd", 0.25, {0.1, "unstable", 0.02, 0.01, {1.5, 1.4, 0.2}, 0.05});
  run("hybmss_fd", 0.4, {0.2, "unstable", 0.04, 0.01, {1.5, 1.4, 0.2}, 0.05});
  run("hybmss", 0.25, {0.5, "inverted cell", 0.3, 0.4, {0.1, 0.1, 0.1}, 0.1});
  run("hybmss_avg", 0.25, {1, "", 0.2, 0.6, {0.1, 0.1, 0.1}, 0.02});
  const Headline h = headline({c});
  EXPECT_EQ(h.answer,
            "In stable equilibrium, on the finest cells and at the worst Poisson's ratio: hybmss_avg under the whole "
            "load, hybmss up to 50 % of the load, hybmss_fd up to 10 % of the load.");
  const std::vector<Warning>& warnings = h.warnings;
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0].brief,
            "press: hybmss loses its equilibrium, ν = 0.25 at 50 % of the load, 30 % of strain: a cell "
            "is turned inside out");
  EXPECT_EQ(
      warnings[1].brief,
      "press: hybmss_fd loses its equilibrium, ν = 0.25 at 10 % of the load, 2 % of strain; ν = 0.4 at 20 % of the "
      "load, 4 % of strain: the lattice wrinkles, neighbours move against each other along x and y: the springs' "
      "failure, not the material's");
  EXPECT_EQ(warnings[1].advice, "hybmss_avg bears the whole load there");
}

TEST(Headline, AStateWithWrinklesIsNoStateOfTheMaterial) {
  CaseResult c = with_errors("press", "hybmss_fd", {});
  c.runs.push_back(lattice_run("hybmss_fd", 0.25, "linear", {1, "", 0.02, {}, {}, 0.4}));
  const Headline h = headline({c});
  ASSERT_EQ(h.warnings.size(), 1u);
  EXPECT_EQ(h.warnings[0].brief,
            "press: hybmss_fd wrinkles from cell to cell, ν = 0.25 (40 % of the strain alternates): a wave of the "
            "lattice, not of the material");
  EXPECT_EQ(h.warnings[0].advice, "no model of the case holds: apply less, or take hybmss_avg");

  c.runs.back().model = "hybmss_avg";  // what else would be recommended
  EXPECT_EQ(headline({c}).warnings[0].advice, "no model of the case holds: apply less");

  c.runs.back().model = "hybmss in motion";
  const Headline moving = headline({c});
  ASSERT_EQ(moving.warnings.size(), 1u);
  EXPECT_NE(moving.warnings[0].brief.find("hybmss in motion ripples from cell to cell"), std::string::npos);
  EXPECT_NE(moving.warnings[0].advice.find("more sudden than its cells can carry"), std::string::npos);
}

TEST(Headline, WhatMayBeLostIsSaidBeforeTheRun) {
  Experiment press;
  press.name = "press";
  EXPECT_EQ(
      limit_sentence(press, {"hybmss", -0.5, -0.2, -0.212, -0.209, "waves of any length grow", "hybmss_avg"}),
      "press: hybmss at ν = −0.5 may lose its equilibrium: it is to be shortened by 20 %, more in places, and its "
      "lattice without end is stable to 21 % with free sides and 21 % with held sides (waves of any length grow); "
      "hybmss_avg is stable there");
}

}  // namespace
}  // namespace springproof::headline_test
