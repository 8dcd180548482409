#include "fem_reference/reference.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fem_reference/exchange.h"

namespace springproof::fem {
namespace {

namespace fs = std::filesystem;

constexpr int exit_status_input_error = 2;

// $SPRINGPROOF_FEM_PROGRAM, else springproof-fem beside the running executable; empty if there is none.
fs::path program() {
  if (const char* given = std::getenv("SPRINGPROOF_FEM_PROGRAM"); given && access(given, X_OK) == 0)
    return given;
  std::error_code ignored;
  const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path() / "springproof-fem";
  return access(beside.c_str(), X_OK) == 0 ? beside : fs::path();
}

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "springproof-fem-XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw std::runtime_error(fmt::format("cannot make {}: {}", name, std::strerror(errno)));
    path = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  fs::path path;
};

std::string read_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// The programs under way, for interrupt().
std::array<std::atomic<pid_t>, 64> children;

class ChildSlot {
 public:
  explicit ChildSlot(pid_t child) {
    for (auto& c : children)
      if (pid_t free = 0; c.compare_exchange_strong(free, child)) {
        slot_ = &c;
        return;
      }
  }
  ~ChildSlot() {
    if (slot_) *slot_ = 0;
  }
  ChildSlot(const ChildSlot&) = delete;
  ChildSlot& operator=(const ChildSlot&) = delete;

 private:
  std::atomic<pid_t>* slot_ = nullptr;
};

// The wait status of the program run with standard output and error written to files, if named.
int wait_status_of(const fs::path& file, const std::vector<std::string>& arguments, const fs::path& output,
                const fs::path& errors) {
  std::vector<char*> argv = {const_cast<char*>(file.c_str())};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0)
    throw std::runtime_error(fmt::format("cannot start {}: {}", file.string(), std::strerror(errno)));
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody waits for the answer of a caller that is gone
    const auto redirect = [](const fs::path& to, int stream) {
      if (!to.empty()) dup2(open(to.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), stream);
    };
    redirect(output, STDOUT_FILENO);
    redirect(errors, STDERR_FILENO);
    execv(file.c_str(), argv.data());
    _exit(127);
  }
  const ChildSlot slot(child);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

fs::path program_or_throw() {
  const fs::path file = program();
  if (file.empty())
    throw std::runtime_error(
        "the program springproof-fem is neither beside this one nor named by "
        "SPRINGPROOF_FEM_PROGRAM");
  return file;
}

std::string trimmed(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text;
}

}  // namespace

std::vector<Solution> solve(const Request& request) {
  const fs::path file = program_or_throw();
  const TemporaryFolder folder;
  const fs::path question = folder.path / "request.cbor", answer = folder.path / "answer.cbor";
  {
    std::ofstream out(question, std::ios::binary);
    nlohmann::json::to_cbor(to_json(request), out);
    if (!out.flush()) throw std::runtime_error("cannot write " + question.string());
  }
  const int status = wait_status_of(file, {"--request", question.string(), "--answer", answer.string()},
                                 folder.path / "output", folder.path / "errors");
  const std::string last_words = trimmed(read_file(folder.path / "errors"));
  if (WIFEXITED(status) && WEXITSTATUS(status) == exit_status_input_error) throw InputError(last_words);
  if (WIFSIGNALED(status))
    throw std::runtime_error(
        fmt::format("springproof-fem was killed by signal {}: {}", WTERMSIG(status), last_words));
  if (WEXITSTATUS(status) != 0)
    throw std::runtime_error(
        fmt::format("springproof-fem failed with status {}: {}", WEXITSTATUS(status), last_words));
  std::ifstream in(answer, std::ios::binary);
  return solutions_from_json(nlohmann::json::from_cbor(in));
}

int run_program(const std::vector<std::string>& arguments) {
  const int status = wait_status_of(program_or_throw(), arguments, {}, {});
  if (WIFSIGNALED(status))
    throw std::runtime_error(fmt::format("springproof-fem was killed by signal {}", WTERMSIG(status)));
  return WEXITSTATUS(status);
}

void interrupt() {
  for (const auto& c : children)
    if (const pid_t child = c; child > 0) kill(child, SIGTERM);
}

bool available() {
  return !program().empty();
}

std::string version() {
  const fs::path file = program();
  if (file.empty()) return {};
  const TemporaryFolder folder;
  const int status = wait_status_of(file, {"--version"}, folder.path / "output", folder.path / "errors");
  return status == 0 ? trimmed(read_file(folder.path / "output")) : std::string();
}

}  // namespace springproof::fem
