#include "fem_reference/exchange/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "fem_reference/exchange/case_request.h"
#include "fem_reference/exchange/exchange.h"
#include "fem_reference/exchange/plain_words.h"
#include "problem/processes/child.h"
#include "problem/processes/fork_server.h"
#include "problem/system/progress.h"

namespace springproof::fem {
namespace {

namespace fs = std::filesystem;

constexpr int exit_status_input_error = 2;

constexpr const char* program_variable = "SPRINGPROOF_FEM_PROGRAM";

fs::path program() { return find_program("springproof-fem", program_variable); }

fs::path program_or_throw() {
  const fs::path file = program();
  if (file.empty())
    throw std::runtime_error(
        "the program springproof-fem is neither beside this one nor named by "
        "SPRINGPROOF_FEM_PROGRAM");
  return file;
}

/// Runs the program, whose standard output is not read.  One that is ours is started once and forks; what
/// $SPRINGPROOF_FEM_PROGRAM names may be any program.
ChildEnd run(const std::vector<std::string>& arguments, const fs::path& output, const fs::path& errors) {
  const fs::path file = program_or_throw();
  if (std::getenv(program_variable)) return run_child({file, arguments, {}, output, errors});
  return run_forked(file, arguments, output, errors);
}

/// Whether the results match the request: a solution per grid, a row per point, the same patches on every grid.
bool answers(const std::vector<Solution>& solutions, const Request& request) {
  if (solutions.size() != request.grids.size()) return false;
  const Solution* first = nullptr;
  for (std::size_t g = 0; g < solutions.size(); ++g) {
    const Solution& s = solutions[g];
    if (s.grid.element != request.grids[g].element) return false;
    if (!s.ok) continue;
    if (!first) first = &s;
    if (request.modes > 0) {
      if (s.frequencies.size() < static_cast<std::size_t>(request.modes) || s.shapes.size() != s.frequencies.size() ||
          std::any_of(s.shapes.begin(), s.shapes.end(),
                      [&](const NodalVectors& u) { return u.rows() != request.points.rows(); }))
        return false;
      continue;
    }
    if (request.motion) {
      if (s.time.empty() || s.path.size() != s.time.size() || s.kinetic_energy.size() != s.time.size() ||
          std::any_of(s.path.begin(), s.path.end(),
                      [&](const NodalVectors& u) { return u.rows() != request.points.rows(); }))
        return false;
      continue;
    }
    const auto same_patch = [](const PatchReaction& a, const PatchReaction& b) { return a.patch == b.patch; };
    if (s.displacement.rows() != request.points.rows() || s.stress.rows() != request.stress_points.rows() ||
        !std::equal(s.reactions.begin(), s.reactions.end(), first->reactions.begin(), first->reactions.end(),
                    same_patch))
      return false;
  }
  return true;
}

std::vector<Solution> read_answer(const fs::path& answer, const Request& request) {
  std::string why = "does not fit the question";
  try {
    const std::vector<Solution> solutions = solutions_from_json(nlohmann::json::from_cbor(text_of_file(answer)));
    if (answers(solutions, request)) return solutions;
  } catch (const std::exception&) {
    why = fs::exists(answer) ? "cannot be read" : "is missing";
  }
  throw std::runtime_error(
      fmt::format("{}: the answer of springproof-fem ({}) {} (build springproof and springproof-fem together)",
                  request.name, program().string(), why));
}

}  // namespace

std::vector<Solution> solve(const Request& asked) {
  program_or_throw();
  Request request = asked;
  mesh_grids(request);  // here, where a mesh serves all of Poisson's ratios
  const TemporaryFolder folder;
  const fs::path question = folder.path / "request.cbor", answer = folder.path / "answer.cbor",
                 errors = folder.path / "errors", progress = folder.path / "progress";
  {
    std::ofstream out(question, std::ios::binary);
    nlohmann::json::to_cbor(to_json(request), out);
    if (!out.flush()) folder.require_room();
  }
  progress::phase("finite elements");
  const progress::Relay relay(progress);
  const ChildEnd end =
      run({"--request", question.string(), "--answer", answer.string(), "--progress", progress.string()},
          folder.path / "output", errors);
  if (!end.ok()) folder.require_room();
  const std::string last_words = plain_words(text_of_file(errors));
  if (end.kind == ChildEnd::exited && end.status == exit_status_input_error) throw InputError(last_words);
  if (!end.ok())
    throw std::runtime_error(fmt::format("{}: springproof-fem {}{}{}", request.name, words_for(end),
                                         last_words.empty() ? "" : ": ", last_words));
  std::vector<Solution> solutions = read_answer(answer, request);
  for (std::size_t g = 0; g < solutions.size(); ++g) {
    solutions[g].grid = asked.grids[g];
    solutions[g].message = plain_words(solutions[g].message);
  }
  return solutions;
}

int run_program(const std::vector<std::string>& arguments) {
  const ChildEnd end = run_child({program_or_throw(), arguments, {}, {}, {}});
  if (end.kind == ChildEnd::killed) throw std::runtime_error(fmt::format("springproof-fem {}", words_for(end)));
  return end.status;
}

bool available() { return !program().empty(); }

std::string version() {
  if (!available()) return {};
  const TemporaryFolder folder;
  const fs::path output = folder.path / "output";
  return run({"--version"}, output, folder.path / "errors").ok() ? trimmed(text_of_file(output)) : std::string();
}

}  // namespace springproof::fem
