#include "problem/processes/in_child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>

#include "problem/processes/child_process.h"

namespace springproof {
namespace {

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
    const ssize_t n = read(from, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text;
    text.append(buffer, std::size_t(n));
  }
}

}  // namespace

std::string in_child(const std::function<std::string()>& work) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  // SIGTERM waits until the child no longer has our handler of it.
  sigset_t terminate, usual;
  sigemptyset(&terminate);
  sigaddset(&terminate, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &terminate, &usual);
  const unsigned before = interrupt_count();
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
    if (interrupt_count() != before) kill(child, SIGTERM);  // the handler may have run before the child was registered
    text = read_all(ends[0]);
  }
  close(ends[0]);
  if (child < 0) throw std::runtime_error("no process");
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status))
    throw std::runtime_error(fmt::format("was killed by signal {} (out of memory?)", WTERMSIG(status)));
  if (status != 0 || text.empty()) throw std::runtime_error("ended early");
  if (text[0] == thrown) throw std::runtime_error(text.substr(1));
  return text.substr(1);
}

}  // namespace springproof
