#include "fem_reference/reference.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "fem_reference/exchange.h"
#include "meshes/child.h"
#include "problem/progress.h"

namespace springproof::fem {
namespace {

namespace fs = std::filesystem;

constexpr int exit_status_input_error = 2;

fs::path program() {
  return find_program("springproof-fem", "SPRINGPROOF_FEM_PROGRAM");
}

fs::path program_or_throw() {
  const fs::path file = program();
  if (file.empty())
    throw std::runtime_error(
        "the program springproof-fem is neither beside this one nor named by "
        "SPRINGPROOF_FEM_PROGRAM");
  return file;
}

}  // namespace

std::vector<Solution> solve(const Request& request) {
  const fs::path file = program_or_throw();
  const TemporaryFolder folder;
  const fs::path question = folder.path / "request.cbor", answer = folder.path / "answer.cbor",
                 errors = folder.path / "errors", progress = folder.path / "progress";
  {
    std::ofstream out(question, std::ios::binary);
    nlohmann::json::to_cbor(to_json(request), out);
    if (!out.flush()) throw std::runtime_error("cannot write " + question.string());
  }
  progress::phase("finite elements");
  const progress::Relay relay(progress);
  const ChildEnd end = run_child({file, {"--request", question.string(), "--answer", answer.string(), "--progress", progress.string()},
                                  {}, folder.path / "output", errors});
  const std::string last_words = trimmed(text_of_file(errors));
  if (end.kind == ChildEnd::exited && end.status == exit_status_input_error) throw InputError(last_words);
  if (!end.ok()) throw std::runtime_error(fmt::format("springproof-fem {}: {}", words_for(end), last_words));
  std::ifstream in(answer, std::ios::binary);
  return solutions_from_json(nlohmann::json::from_cbor(in));
}

int run_program(const std::vector<std::string>& arguments) {
  const ChildEnd end = run_child({program_or_throw(), arguments, {}, {}, {}});
  if (end.kind == ChildEnd::killed) throw std::runtime_error(fmt::format("springproof-fem {}", words_for(end)));
  return end.status;
}

void interrupt() {
  interrupt_children();
}

bool available() {
  return !program().empty();
}

std::string version() {
  const fs::path file = program();
  if (file.empty()) return {};
  const TemporaryFolder folder;
  const fs::path output = folder.path / "output";
  const bool ok = run_child({file, {"--version"}, {}, output, folder.path / "errors"}).ok();
  return ok ? trimmed(text_of_file(output)) : std::string();
}

}  // namespace springproof::fem
