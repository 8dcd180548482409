#include "problem/processes/fork_server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "problem/processes/child_process.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

// A run: the fields, each ended by a zero, and one zero more.  The answer: a ChildEnd, as it is in memory.
bool send_all(int socket, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t sent = TEMP_FAILURE_RETRY(send(socket, bytes, count, MSG_NOSIGNAL));
    if (sent <= 0) return false;
    bytes += sent;
    count -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int socket, void* to, std::size_t count) {
  for (char* at = static_cast<char*>(to); count > 0;) {
    const ssize_t got = TEMP_FAILURE_RETRY(recv(socket, at, count, 0));
    if (got <= 0) return false;
    at += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

/// The fields of the next run; none: the caller has ended.
std::vector<std::string> receive_run(int socket) {
  std::vector<std::string> fields(1);
  for (char c; receive_all(socket, &c, 1);) {
    if (c != '\0')
      fields.back() += c;
    else if (fields.back().empty())
      return fields.pop_back(), fields;
    else
      fields.emplace_back();
  }
  return {};
}

/// A server as its caller sees it.
class Server {
 public:
  explicit Server(const fs::path& program) : program_(program) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail();
    std::string name = program.string(), argument = fork_server_argument;
    char* argv[] = {name.data(), argument.data(), nullptr};
    pid_ = fork();
    if (pid_ == 0) {  // only async-signal-safe calls: other threads may hold any lock
      dup2(ends[1], STDIN_FILENO);
      execv(argv[0], argv);
      _exit(not_started);
    }
    close(ends[1]);
    socket_ = ends[0];
    if (pid_ < 0) fail();
    slot_.emplace(pid_);
  }

  ~Server() {
    slot_.reset();
    close(socket_);
    TEMP_FAILURE_RETRY(waitpid(pid_, nullptr, 0));
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  const fs::path& program() const { return program_; }

  /// False: the server has ended; `end` tells how.
  bool run(const std::string& fields, ChildEnd& end) {
    if (send_all(socket_, fields.data(), fields.size()) && receive_all(socket_, &end, sizeof end)) return true;
    siginfo_t info{};
    TEMP_FAILURE_RETRY(waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT));
    end = {};
    end.kind = info.si_code == CLD_EXITED ? ChildEnd::exited : ChildEnd::killed;
    end.status = end.kind == ChildEnd::exited && info.si_status == 0 ? not_started : info.si_status;
    return false;
  }

  void interrupt() const { kill(pid_, SIGTERM); }

 private:
  [[noreturn]] void fail() const {
    throw std::runtime_error(fmt::format("cannot start {}: {}", program_.string(), std::strerror(errno)));
  }

  fs::path program_;
  int socket_ = -1;
  pid_t pid_ = -1;
  std::optional<ChildSlot> slot_;
};

std::mutex idle_mutex;
std::vector<std::unique_ptr<Server>> idle;

std::unique_ptr<Server> idle_server(const fs::path& program) {
  const std::lock_guard lock(idle_mutex);
  const auto found = std::ranges::find_if(idle, [&](const auto& s) { return s->program() == program; });
  if (found == idle.end()) return nullptr;
  std::unique_ptr<Server> server = std::move(*found);
  idle.erase(found);
  return server;
}

[[noreturn]] void run_in_fork(std::vector<std::string>& fields, int (*run)(int, char**)) {
  const auto redirect = [](const char* to, int flags, int stream) { dup2(open(to, flags | O_CLOEXEC, 0600), stream); };
  redirect("/dev/null", O_RDONLY, STDIN_FILENO);
  redirect(fields[0].c_str(), O_WRONLY | O_CREAT | O_APPEND, STDOUT_FILENO);
  redirect(fields[1].c_str(), O_WRONLY | O_CREAT | O_APPEND, STDERR_FILENO);
  std::vector<char*> argv;
  for (auto field = fields.begin() + 2; field != fields.end(); ++field) argv.push_back(field->data());
  argv.push_back(nullptr);
  std::exit(run(static_cast<int>(argv.size()) - 1, argv.data()));
}

}  // namespace

ChildEnd run_forked(const fs::path& program, const std::vector<std::string>& arguments, const fs::path& output,
                    const fs::path& errors) {
  std::string fields;
  for (const std::string& field : {output.string(), errors.string(), program.string()}) fields += field + '\0';
  for (const std::string& argument : arguments) fields += argument + '\0';
  fields += '\0';
  const unsigned before = interrupt_count();
  std::unique_ptr<Server> server = idle_server(program);
  if (!server) server = std::make_unique<Server>(program);
  if (interrupt_count() != before) server->interrupt();  // the handler may have run before the server was registered
  ChildEnd end;
  if (!server->run(fields, end)) return end;
  const std::lock_guard lock(idle_mutex);
  idle.push_back(std::move(server));
  return end;
}

int serve_forks(int (*run)(int argc, char** argv)) {
  const int socket = STDIN_FILENO;
  sigset_t child_ends, usual;
  sigemptyset(&child_ends);
  sigaddset(&child_ends, SIGCHLD);
  signal(SIGCHLD, [](int) {});  // so that it interrupts ppoll()
  for (std::vector<std::string> fields; !(fields = receive_run(socket)).empty();) {
    if (fields.size() < 3) return 2;
    sigprocmask(SIG_BLOCK, &child_ends, &usual);
    const pid_t server = getpid(), pid = fork();
    if (pid < 0) return 1;
    if (pid == 0) {
      signal(SIGCHLD, SIG_DFL);
      sigprocmask(SIG_SETMASK, &usual, nullptr);
      end_with_parent(server);
      run_in_fork(fields, run);
    }
    int status = 0;
    rusage used{};
    while (wait4(pid, &status, WNOHANG, &used) == 0) {
      pollfd caller = {socket, POLLRDHUP, 0};
      if (ppoll(&caller, 1, nullptr, &usual) > 0) {  // the caller has ended
        kill(pid, SIGKILL);
        return 1;
      }
    }
    sigprocmask(SIG_SETMASK, &usual, nullptr);
    const ChildEnd end = end_of(status, used);
    if (!send_all(socket, reinterpret_cast<const char*>(&end), sizeof end)) return 1;
  }
  return 0;
}

}  // namespace springproof
