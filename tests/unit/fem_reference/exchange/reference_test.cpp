// The way through the separate program: request, answer, errors.
#include "fem_reference/exchange/reference.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "fem_reference/exchange/case_request.h"
#include "fem_reference/exchange/exchange.h"
#include "fem_reference/solve_grid.h"
#include "problem/processes/child.h"

namespace springproof::reference_test {
namespace {

std::string squeezed_cube(const std::string& patch) {
  return R"(
kinematics = "linear"
[body]
geo = "block.geo"
size_m = [5, 5, 5]
cells = [4, 4, 4]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.25
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = ")" +
         patch +
         R"("
displacement_m = [0, 0, -0.25]
[compare]
models = ["hybmss"]
measures = ["volume_change"]
)";
}

fem::Request request(const std::string& patch = "z_max") {
  const Experiment experiment = parse_experiment(squeezed_cube(patch), "cube.toml");
  fem::Request request = fem::request_of(experiment, experiment.materials.front());
  request.grids = {{{4, 4, 4}, "q2", 1.0}, {{6, 6, 6}, "q1", 1.5}};
  request.points = Eigen::RowVector3d(1, 2, 3);
  return request;
}

TEST(FemReference, AnswersAsTheSolverInThisProcess) {
  ASSERT_TRUE(fem::available());
  EXPECT_EQ(fem::version(), fem::library_versions());
  const std::vector<fem::Solution> solutions = fem::solve(request());
  ASSERT_EQ(solutions.size(), 2u);

  fem::GridProblem problem;
  problem.coarse = block_mesh(Vec3(5, 5, 5), {3, 3, 3});
  problem.refinements = 1;
  problem.place = fem::graded(Vec3::Zero(), Vec3(5, 5, 5), 1.5);
  problem.degree = 1;
  problem.material = request().material;
  problem.loads = request().loads;
  problem.points = request().points;
  const fem::Solution here = fem::solve_grid(problem), &there = solutions[1];
  ASSERT_TRUE(there.ok) << there.message;
  EXPECT_EQ(there.grid.cells, (Cells{6, 6, 6}));
  EXPECT_EQ(there.degrees_of_freedom, 3 * 7 * 7 * 7);
  EXPECT_EQ(there.form, here.form);
  EXPECT_LE((there.displacement - here.displacement).norm(), 1e-8);
  ASSERT_EQ(there.reactions.size(), 2u);
  EXPECT_EQ(there.reactions[1].patch, "z_max");
  EXPECT_NEAR(there.reactions[1].force[2], here.reactions[1].force[2], 1e-4);
  EXPECT_NEAR(there.volume_change, here.volume_change, 1e-9);
}

TEST(FemReference, PassesOnThatTheInputIsWrong) {
  try {
    fem::solve(request("lid"));
    FAIL() << "no error";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("lid"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("z_max"), std::string::npos);
  }
}

/// What solve() says when this shell script is the program.
std::string with_program(const std::string& script) {
  const TemporaryFolder folder;
  const std::filesystem::path program = folder.path / "program";
  std::ofstream(program) << "#!/bin/sh\n" << script << "\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  setenv("SPRINGPROOF_FEM_PROGRAM", program.c_str(), 1);
  std::string says = "accepted";
  try {
    fem::solve(request());
  } catch (const std::runtime_error& e) {
    says = e.what();
  }
  unsetenv("SPRINGPROOF_FEM_PROGRAM");
  return says;
}

// --request FILE --answer FILE: the answer's name is the fourth word.
TEST(FemReference, OddAnswersAreOneSentenceThatNamesProgramAndCase) {
  const auto answers = [](const std::string& text, const char* why) {
    const std::string says = with_program("printf '" + text + "' > \"$4\"");
    EXPECT_EQ(says.rfind("cube.toml: the answer of springproof-fem (", 0), 0u) << says;
    EXPECT_NE(says.find(why), std::string::npos) << says;
    EXPECT_EQ(says.find("json"), std::string::npos) << says;
  };
  answers("", "cannot be read");
  answers("nonsense", "cannot be read");
  answers("\\200", "does not fit the question");  // []
  answers("\\202\\240\\240", "cannot be read");   // [{}, {}]
  answers("\\366", "cannot be read");             // null
  EXPECT_NE(with_program("exit 0").find("cube.toml: the answer of springproof-fem ("), std::string::npos);
  EXPECT_EQ(with_program("echo out of luck >&2; kill -SEGV $$"),
            "cube.toml: springproof-fem was killed by signal 11 (Segmentation fault): out of luck");
}

TEST(FemReference, AnswersOfAnotherQuestionAreRefused) {
  const TemporaryFolder folder;
  const std::vector<fem::Solution> fits = fem::solve(request());
  const auto says = [&](const std::function<void(std::vector<fem::Solution>&)>& spoil) {
    std::vector<fem::Solution> solutions = fits;
    spoil(solutions);
    std::ofstream out(folder.path / "answer", std::ios::binary);
    nlohmann::json::to_cbor(to_json(solutions), out);
    out.close();
    return with_program("cp '" + (folder.path / "answer").string() + "' \"$4\"");
  };
  EXPECT_EQ(says([](auto&) {}), "accepted");
  EXPECT_NE(says([](auto& s) { s.pop_back(); }), "accepted");
  EXPECT_NE(says([](auto& s) { s[0].displacement.resize(0, 3); }), "accepted");
  EXPECT_NE(says([](auto& s) { s[1].stress.resize(3, 6); }), "accepted");
  EXPECT_NE(says([](auto& s) { s[1].reactions.pop_back(); }), "accepted");
  EXPECT_NE(says([](auto& s) { s[0].grid.element = "p2"; }), "accepted");
}

TEST(FemReference, SaysWhyTheProgramFailed) {
  setenv("SPRINGPROOF_FEM_PROGRAM", "/bin/false", 1);
  EXPECT_THROW(fem::solve(request()), std::runtime_error);
  EXPECT_EQ(fem::version(), "");
  unsetenv("SPRINGPROOF_FEM_PROGRAM");
}

}  // namespace
}  // namespace springproof::reference_test
