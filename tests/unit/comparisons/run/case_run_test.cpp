// Measures, verdicts and kept parts.
#include "comparisons/run/case_run.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <map>

#include "comparisons/judge/judge.h"
#include "comparisons/judge/measures.h"
#include "comparisons/run/prepare.h"
#include "comparisons/sweep/folder_lock.h"
#include "comparisons/sweep/suite_results.h"
#include "comparisons/sweep/sweep.h"
#include "problem/processes/child.h"

namespace springproof::case_run_test {
namespace {

TEST(Measures, DistancesAreWhatTheySay) {
  const Mesh mesh = block_mesh({1, 1, 1}, {2, 2, 2});
  NodalVectors v = NodalVectors::Zero(27, 3);
  v.col(2).setConstant(0.5);
  NodalVectors u = v;
  u.col(0).setConstant(0.1);
  EXPECT_NEAR(displacement_error(u, v, nodal_volumes(mesh)), 0.2, 1e-14);
  EXPECT_NEAR(section_distance(mesh, {{0.5, 0.5, 0.5}, {0, 0, 2}}, u, v), 0.1, 1e-14);
  EXPECT_THROW(section_distance(mesh, {{0, 0, 0.3}, {0, 0, 1}}, u, v), InputError);
  u.col(1).setConstant(-0.3);
  u.col(2).setConstant(7);
  EXPECT_NEAR(section_axis_distance(mesh, {{0.5, 0.5, 0.5}, {0, 0, 2}}, u, v), (0.1 + 0.3) / 2, 1e-14);
}

TEST(Measures, InterpolationIsExactForTrilinearFields) {
  const Mesh mesh = block_mesh({1, 2, 3}, {2, 3, 4});
  NodalVectors u(mesh.nodes.rows(), 3);
  const auto field = [](const Vec3& X) { return Vec3(1 + X[0], 2 * X[1] - X[2], X[0] - 3 * X[2]); };
  for (int n = 0; n < u.rows(); ++n) u.row(n) = field(mesh.nodes.row(n)).transpose();
  NodalVectors points(3, 3);
  points << 0.13, 1.9, 2.7, 1, 2, 3, 0.5, 0.01, 0;
  const NodalVectors at = interpolate(mesh, u, points);
  for (int i = 0; i < 3; ++i) EXPECT_LE((at.row(i).transpose() - field(points.row(i))).norm(), 1e-13);
  points(0, 0) = 1.5;
  EXPECT_THROW(interpolate(mesh, u, points), InputError);
}

CaseResult one_row(double value, double reference, double uncertainty) {
  CaseResult result;
  result.cells = {{4, 4, 4}};
  result.experiment.materials = {{1e4, 0.25, 1000}};
  result.rows = {{{"hybmss", 0.25, {4, 4, 4}},
                  "case",
                  "linear",
                  "volume_change",
                  value,
                  "1",
                  reference,
                  uncertainty,
                  value - reference}};
  return result;
}

Verdict verdict(CaseResult result, const Expectation& e) {
  result.experiment.expectations = {e};
  judge(result);
  EXPECT_EQ(result.checks.size(), 1u);
  return result.checks.at(0).verdict;
}

TEST(Judge, DecidesByToleranceAndByTheReferencesUncertainty) {
  Expectation e{"hybmss", {}, {}, "volume_change", Source::extrapolated_fem, {}, 0.01, false, {}, "", {}};
  EXPECT_EQ(verdict(one_row(0.105, 0.1, 0.001), e), Verdict::pass);
  EXPECT_EQ(verdict(one_row(0.111, 0.1, 0.001), e), Verdict::fail);
  EXPECT_EQ(verdict(one_row(0.105, 0.1, 0.0026), e), Verdict::reference_too_coarse);
  EXPECT_EQ(verdict(one_row(0.111, 0.1, 0.0026), e), Verdict::reference_too_coarse);
  EXPECT_EQ(verdict(one_row(0.2, 0.1, 0.0026), e), Verdict::fail);  // beyond doubt
  CaseResult without = one_row(0.105, 0.1, 0);
  without.rows[0].reference.reset();
  without.rows[0].reference_uncertainty.reset();
  EXPECT_EQ(verdict(without, e), Verdict::no_reference);
  e.source = Source::published;
  e.value = 0.12;
  EXPECT_EQ(verdict(without, e), Verdict::fail);
  e.within = 0.2;
  e.relative = true;
  EXPECT_EQ(verdict(without, e), Verdict::pass);
  e.model = "msm_18";
  EXPECT_EQ(verdict(without, e), Verdict::no_result);
}

/// The reference alone, with the limits of two elements.
CaseResult two_elements() {
  CaseResult result;
  result.cells = {{4, 4, 4}};
  result.experiment.materials = {{1e4, 0.25, 1000}};
  result.experiment.reference.elements = {"q2", "p1"};
  for (const auto& [element, limit] : {std::pair("q2", 1.0), std::pair("p1", 0.8)})
    result.references.push_back({0.25, "displacement.tip.z", "m", {}, {}, 2.0, limit, 1e-4, "", element});
  return result;
}

TEST(Judge, TakesTheLimitOfTheElementThatIsNamed) {
  Expectation e{"fem", {}, {}, "displacement.tip.z", Source::analytic, 1.0, 0.01, false, {}, "", {}};
  EXPECT_EQ(verdict(two_elements(), e), Verdict::pass);
  e.model = "fem_q2";
  EXPECT_EQ(verdict(two_elements(), e), Verdict::pass);
  e.model = "fem_p1";
  EXPECT_EQ(verdict(two_elements(), e), Verdict::fail);
  e.model = "fem_p2";
  EXPECT_EQ(verdict(two_elements(), e), Verdict::no_result);
}

TEST(Judge, BesideModelsAComparedElementIsTheirPeer) {
  Experiment e;
  e.reference.elements = {"q1", "p2"};
  EXPECT_EQ(reference_element(e, "fem"), "q1");
  EXPECT_EQ(reference_element(e, "fem_q1"), "q1");
  EXPECT_EQ(reference_element(e, "fem_p2"), "p2");
  EXPECT_FALSE(reference_element(e, "hybmss"));
  e.models.push_back({"hybmss", {}, "hybmss", {}});
  EXPECT_EQ(reference_element(e, "fem"), "q1");
  EXPECT_FALSE(reference_element(e, "fem_q1"));
  EXPECT_EQ(reference_element(e, "fem_p2"), "p2");
  e.elements = {"p2"};
  EXPECT_EQ(reference_element(e, "fem_q1"), "q1");
  EXPECT_FALSE(reference_element(e, "fem_p2"));
}

TEST(Judge, ALowerBoundHasNoTolerance) {
  Expectation e{"fem", {}, {}, "displacement.tip.z", Source::analytic, {}, 0, false, 1.0, "", {}};
  EXPECT_EQ(verdict(two_elements(), e), Verdict::pass);
  e.at_least = 1.0001;
  EXPECT_EQ(verdict(two_elements(), e), Verdict::fail);
  e.at_least = 0.9;
  EXPECT_EQ(verdict(two_elements(), e), Verdict::pass);
  e.measure = "displacement.tip.x";
  EXPECT_EQ(verdict(two_elements(), e), Verdict::no_result);
}

TEST(PartFile, ComesBackWholeOrNotAtAll) {
  const auto file = std::filesystem::temp_directory_path() / "springproof_part_test.cbor";
  Part part;
  part.runs = {{{"hybmss", 0.25, {1, 2, 3}}, "msm", "linear", false, "why not", "CG", 7, 1e-11, 0.5, 99, 12.5, 0.25}};
  part.rows = one_row(0.1, 0.2, 0.003).rows;
  part.rows.push_back({{"fem", 0.25, {4, 4, 4}}, "case", "linear", "volume_change", 0.1, "1", {}, {}, {}});
  part.references = {{0.25, "volume_change", "1", {{1, 1, 1}}, {0.1, 0.2}, {}, 0.2, 0.1, "note", "p1"}};
  part.pictures = {{"fem", 0.25, {4, 4, 4}, {0, 1, 2}, {3, 4, 5}, {}, {0, 0, 0, 0}, {}, "cells"}};
  save_part(file, "stamp", part);
  const std::optional<Part> back = load_part(file, "stamp");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->runs.at(0).message, "why not");
  EXPECT_EQ(back->runs.at(0).unknowns, 99);
  EXPECT_EQ(back->runs.at(0).set_up_seconds, 0.25);
  EXPECT_EQ(back->rows.at(0).reference, 0.2);
  EXPECT_FALSE(back->rows.at(1).reference);
  EXPECT_FALSE(back->references.at(0).observed_order);
  EXPECT_EQ(back->references.at(0).element, "p1");
  EXPECT_EQ(back->pictures.at(0).displacement, (std::vector<float>{3, 4, 5}));
  EXPECT_FALSE(load_part(file, "other stamp"));
  const std::string bytes = text_of_file(file);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string flipped = bytes;
    flipped[at] ^= 1 << at % 8;
    write_file(file, flipped);
    EXPECT_THROW(load_part(file, "stamp"), DamagedFile) << "byte " << at << " of " << bytes.size();
  }
  for (const std::size_t length : {std::size_t{0}, std::size_t{10}, bytes.size() / 2, bytes.size() - 1}) {
    write_file(file, bytes.substr(0, length));
    EXPECT_THROW(load_part(file, "stamp"), DamagedFile) << length << " bytes left";
  }
  write_file(file, bytes + bytes);
  EXPECT_THROW(load_part(file, "stamp"), DamagedFile);
  std::filesystem::remove(file);
  EXPECT_FALSE(load_part(file, "stamp"));
}

// In the comparison's program, which links everything that a network is made with.
TEST(CaseRun, SpringsWithoutTheCasesLawFollowHenckys) {
  for (const auto& [kinematics, law] : std::map<std::string, std::string>{
           {"st_venant_kirchhoff", "hencky"}, {"log_cauchy", "hencky"}, {"neo_hooke", "neo_hooke"}}) {
    const PreparedCase prepared = prepare(parse_experiment("kinematics = \"" + kinematics + "\"" + R"(
[body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [2, 2, 2]
[material]
youngs_modulus_Pa = 1e5
poisson_ratio = 0.3
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[compare]
models = ["hybmss_avg", "msm_18", { model = "hybmss_avg", curve = "springs_neo_hooke" }]
)",
                                                           "cube.toml"));
    const std::map<std::string, std::string> laws = case_of(prepared).laws;
    EXPECT_EQ(laws.size(), 2u);
    EXPECT_EQ(laws.at("hybmss_avg"), law);
    EXPECT_EQ(laws.at(prepared.experiment.models[2].label), "neo_hooke_isochoric");
  }
}

TEST(CaseRun, WhatRestsHasNeitherRipplesNorDrifts) {
  const Part part = run_part(prepare(parse_experiment(R"(kinematics = "hencky"
[body]
geo = "block.geo"
size_m = [0.2, 0.1, 0.1]
cells = [8, 4, 4]
[material]
youngs_modulus_Pa = 1e5
poisson_ratio = 0.3
[compare]
models = ["hybmss_avg"]
[reference]
elements = []
[dynamics]
duration_s = 0.05
equilibrium = false
)",
                                                      "rest.toml")),
                             0, {});
  ASSERT_EQ(part.histories.size(), 1u);
  for (const auto& [name, value] : part.histories[0].measured) EXPECT_FALSE(name.ends_with("_drift")) << value;
  ASSERT_EQ(part.runs.size(), 1u);
  EXPECT_EQ(part.runs[0].stability.value().wrinkles, 0);
}

TEST(Prepare, ANetworkThatJamsIsRefusedAtItsModel) {
  const Experiment e = parse_experiment(R"([body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [6, 6, 6]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.25
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "z_max"
displacement_m = [0, 0, 0.01]
[compare]
models = [{ model = "msm_random", min_length = 0.95 }]
[reference]
elements = []
)",
                                        "jam.toml");
  try {
    prepare(e);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what())
                  .rfind("jam.toml:15:11: compare.models: msm_random: min_length: minL/l = 0.95 was asked for, but "
                         "random addition jams",
                         0),
              0u)
        << error.what();
  }
}

TEST(FolderLock, IsOneProcessAtATimeAndLeavesNothing) {
  const TemporaryFolder folder;
  const std::string path = folder.path / "out";
  std::filesystem::create_directory(path);
  {
    const FolderLock first(path);
    try {
      const FolderLock second(path);
      FAIL() << "held twice";
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("--out: " + path + " is in use"), std::string::npos) << e.what();
    }
  }
  EXPECT_NO_THROW(FolderLock{path});
  EXPECT_TRUE(std::filesystem::is_empty(path));
  const pid_t killed = fork();
  if (killed == 0) {
    const FolderLock held(path);
    raise(SIGKILL);
  }
  waitpid(killed, nullptr, 0);
  EXPECT_NO_THROW(FolderLock{path}) << "the lock of a killed process";
}

}  // namespace
}  // namespace springproof::case_run_test
