#include "problem/processes/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <regex>
#include <sstream>
#include <thread>

#include "problem/processes/child_process.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

// Process ids of the running children, for interrupt_children(): a list that only grows, so that a signal handler may
// traverse it.
struct Children {
  std::array<std::atomic<pid_t>, 64> pids{};
  std::atomic<Children*> next = nullptr;
};
Children children;
std::atomic<unsigned> interrupts = 0;

std::atomic<pid_t>& slot_for(pid_t child) {
  for (Children* block = &children;; block = block->next) {
    for (auto& pid : block->pids)
      if (pid_t free = 0; pid.compare_exchange_strong(free, child)) return pid;
    if (block->next) continue;
    auto* more = new Children;
    if (Children* none = nullptr; !block->next.compare_exchange_strong(none, more)) delete more;
  }
}

// Between fork and exec only async-signal-safe calls: other threads may hold any lock.
[[noreturn]] void become(const Child& child, char** argv, pid_t parent) {
  if (child.group) setpgid(0, 0);
  end_with_parent(parent);
  const auto redirect = [](const fs::path& to, int stream) {
    if (!to.empty()) dup2(open(to.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600), stream);
  };
  if (!child.folder.empty() && chdir(child.folder.c_str()) != 0) _exit(not_started);
  redirect(child.output, STDOUT_FILENO);
  redirect(child.errors, STDERR_FILENO);
  execv(child.program.c_str(), argv);
  _exit(not_started);
}

pid_t start(const Child& child) {
  std::vector<char*> argv = {const_cast<char*>(child.program.c_str())};
  for (const std::string& a : child.arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  const pid_t parent = getpid(), pid = fork();
  if (pid < 0)
    throw std::runtime_error(fmt::format("cannot start {}: {}", child.program.string(), std::strerror(errno)));
  if (pid == 0) become(child, argv.data(), parent);
  return pid;
}

// Waits without reaping, so that the process id is not reused while interrupt_children() may signal it.
bool has_ended(pid_t pid, bool wait) {
  siginfo_t info{};
  while (waitid(P_PID, pid, &info, WEXITED | WNOWAIT | (wait ? 0 : WNOHANG)) < 0)
    if (errno != EINTR) return true;
  return info.si_pid == pid;
}

/// False if the child was killed at its time limit.
bool wait_for(pid_t pid, const Child& child) {
  if (!(child.time_limit > 0)) return has_ended(pid, true);
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  while (!has_ended(pid, false)) {
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    if (seconds > child.time_limit) {
      if (child.group) kill(-pid, SIGKILL);
      kill(pid, SIGKILL);
      has_ended(pid, true);
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(seconds < 1 ? 1 : 10));
  }
  return true;
}

constexpr char returned = 'r', thrown = 't';  // before what the child sends

[[noreturn]] void answer(const std::function<std::string()>& work, int to) noexcept {
  std::string text;
  try {
    text = returned + work();
  } catch (const std::exception& e) {
    text = thrown + std::string(e.what());
  }
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t n = write(to, text.data() + sent, text.size() - sent);
    if (n < 0) _exit(1);
    sent += std::size_t(n);
  }
  _exit(0);
}

std::string read_all(int from) {
  std::string text;
  char buffer[4096];
  for (;;) {
    const ssize_t n = TEMP_FAILURE_RETRY(read(from, buffer, sizeof buffer));
    if (n <= 0) return text;
    text.append(buffer, std::size_t(n));
  }
}

/// The folder of the running executable.
fs::path own_folder() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored).parent_path();
}

constexpr std::string_view folder_prefix = "springproof-temporary-";  // no likely name for a folder of results
constexpr std::string_view unlocked_prefix = ".springproof-";         // of a folder that is not locked yet
constexpr const char* mark = ".springproof-temporary";                // a file in each folder of ours, first and last

/// Where temporary folders are made.
fs::path temporary_place() {
  const char* given = std::getenv("TMPDIR");
  return given && *given ? given : "/tmp";
}

[[noreturn]] void no_room(const fs::path& at, int error) {
  throw NoRoom(fmt::format("TMPDIR: cannot write {}: {} (name a folder with room: TMPDIR=FOLDER springproof ...)",
                           at.string(), std::strerror(error)));
}

/// Locks the folder until the descriptor returned is closed or the process ends; -1: another process holds the lock, or
/// the folder belongs to another user.
int lock_folder(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  struct stat owner {};
  if (descriptor >= 0 && fstat(descriptor, &owner) == 0 && owner.st_uid == geteuid() &&
      flock(descriptor, LOCK_EX | LOCK_NB) == 0)
    return descriptor;
  if (descriptor >= 0) close(descriptor);
  return -1;
}

/// The mark goes last: what is left of the folder of one that is killed meanwhile is still known.
void remove_marked(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (std::error_code ignored; entry->path().filename() != mark) fs::remove_all(entry->path(), ignored);
  fs::remove_all(folder, error);
}

/// @return whether the folder now has its mark.
bool set_mark(const fs::path& folder) {
  const int descriptor = open((folder / mark).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (descriptor >= 0) close(descriptor);
  return descriptor >= 0;
}

}  // namespace

// Removes folders named as ours that no process has locked, where they are empty or have our mark.
void remove_orphans() {
  static const std::regex ours(
      fmt::format("{}[0-9]+-[0-9A-Za-z]{{6}}|\\{}[0-9A-Za-z]{{6}}", folder_prefix, unlocked_prefix));
  std::error_code error;
  for (fs::directory_iterator entry(temporary_place(), error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& folder = entry->path();
    if (!std::regex_match(folder.filename().string(), ours)) continue;
    const int lock = lock_folder(folder);
    if (lock < 0) continue;
    std::error_code none;
    fs::is_regular_file(fs::symlink_status(folder / mark, none)) ? remove_marked(folder) : void(rmdir(folder.c_str()));
    close(lock);
  }
}

// The folder gets its final name after it is locked and marked; before that another process may take it for an orphan
// and remove it, and it is made again.
TemporaryFolder::TemporaryFolder() {
  const fs::path place = temporary_place();
  static std::once_flag first;
  std::call_once(first, remove_orphans);
  constexpr int most_trials = 3;
  for (int trial = 1;; ++trial) {
    std::string name = (place / fmt::format("{}XXXXXX", unlocked_prefix)).string();
    if (!mkdtemp(name.data())) no_room(name, errno);
    lock_ = lock_folder(name);
    path = place / fmt::format("{}{}-{}", folder_prefix, getpid(), name.substr(name.size() - 6));
    const bool last = trial == most_trials;  // where nothing can be locked, it goes on without
    if ((lock_ >= 0 || last) && set_mark(name) && std::rename(name.c_str(), path.c_str()) == 0) return;
    const int error = errno;
    remove_marked(name);
    if (lock_ >= 0) close(lock_);
    if (last) no_room(path, error);
  }
}

TemporaryFolder::~TemporaryFolder() {
  remove_marked(path);
  if (lock_ >= 0) close(lock_);
}

void TemporaryFolder::require_room() const {
  const fs::path trial = path / "trial";
  std::ofstream out(trial, std::ios::binary);
  out << std::string(1 << 16, 'x');
  out.close();
  const int error = errno;
  if (!out) no_room(trial, error);
  std::error_code ignored;
  fs::remove(trial, ignored);
}

ChildSlot::ChildSlot(pid_t child) : slot_(slot_for(child)) {}

unsigned interrupt_count() { return interrupts; }

void end_with_parent(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(not_started);
}

ChildEnd end_of(int status, const rusage& used) {
  ChildEnd end;
  end.kind = WIFSIGNALED(status) ? ChildEnd::killed : ChildEnd::exited;
  end.status = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
  end.seconds = double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  return end;
}

ChildEnd run_child(const Child& child) {
  const unsigned before = interrupts;
  const pid_t pid = start(child);
  bool in_time;
  {
    const ChildSlot slot(pid);
    if (interrupts != before) kill(pid, SIGTERM);  // the signal handler may have run before the child was registered
    in_time = wait_for(pid, child);
  }
  int status = 0;
  rusage used{};
  while (wait4(pid, &status, 0, &used) < 0)
    if (errno != EINTR)
      throw std::runtime_error(fmt::format("lost {}: {}", child.program.string(), std::strerror(errno)));
  ChildEnd end = end_of(status, used);
  if (!in_time) end.kind = ChildEnd::out_of_time;
  return end;
}

std::string in_child(const std::function<std::string()>& work) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  // SIGTERM waits until the child no longer has our handler of it.
  sigset_t terminate, usual;
  sigemptyset(&terminate);
  sigaddset(&terminate, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &terminate, &usual);
  const unsigned before = interrupts;
  const pid_t parent = getpid(), child = fork();
  if (child == 0) {
    std::signal(SIGINT, SIG_IGN);  // the parent ends the child
    std::signal(SIGTERM, SIG_DFL);
    pthread_sigmask(SIG_SETMASK, &usual, nullptr);
    end_with_parent(parent);
    close(ends[0]);
    answer(work, ends[1]);
  }
  pthread_sigmask(SIG_SETMASK, &usual, nullptr);
  close(ends[1]);
  std::string text;
  if (child > 0) {
    const ChildSlot slot(child);
    if (interrupts != before) kill(child, SIGTERM);  // the handler may have run before the child was registered
    text = read_all(ends[0]);
  }
  close(ends[0]);
  if (child < 0) throw std::runtime_error("no process");
  int status = 0;
  TEMP_FAILURE_RETRY(waitpid(child, &status, 0));
  if (WIFSIGNALED(status))
    throw std::runtime_error(fmt::format("was killed by signal {} (out of memory?)", WTERMSIG(status)));
  if (status != 0 || text.empty()) throw std::runtime_error("ended early");
  if (text[0] == thrown) throw std::runtime_error(text.substr(1));
  return text.substr(1);
}

void interrupt_children() {
  ++interrupts;
  for (const Children* block = &children; block; block = block->next)
    for (const auto& pid : block->pids)
      if (const pid_t child = pid; child > 0) kill(child, SIGTERM);
}

bool children_interrupted() { return interrupts > 0; }

std::string words_for(const ChildEnd& end, double time_limit) {
  switch (end.kind) {
    case ChildEnd::out_of_time:
      return fmt::format("took longer than {:g} s and was ended", time_limit);
    case ChildEnd::killed:
      return fmt::format("was killed by signal {} ({})", end.status, strsignal(end.status));
    default:
      return end.status == not_started ? "could not be started" : fmt::format("failed with status {}", end.status);
  }
}

fs::path find_program(const std::string& name, const char* variable) {
  if (const char* given = std::getenv(variable); given && access(given, X_OK) == 0) return given;
  const fs::path beside = own_folder() / name;
  return access(beside.c_str(), X_OK) == 0 ? beside : fs::path();
}

fs::path cache_folder() {
  const auto variable = [](const char* name) { return fs::path(std::getenv(name) ? std::getenv(name) : ""); };
  const fs::path given = variable("XDG_CACHE_HOME"), home = variable("HOME");
  if (!given.empty()) return given / "springproof";
  return home.empty() ? home : home / ".cache" / "springproof";
}

fs::path data_folder(const std::string& name, const fs::path& source) {
  const fs::path installed = own_folder().parent_path() / "share/springproof" / name;
  std::error_code ignored;
  return fs::is_directory(installed, ignored) ? installed : source;
}

fs::path program_on_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file = fs::path(folder.empty() ? "." : folder) / name;
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0) return fs::absolute(file);
  }
  return {};
}

std::string version_of(const fs::path& program) {
  if (program.empty()) return {};
  const TemporaryFolder folder;
  const fs::path output = folder.path / "output";
  const bool ok = run_child({program, {"--version"}, {}, output, folder.path / "errors"}).ok();
  return ok ? trimmed(text_of_file(output)) : std::string();
}

}  // namespace springproof
