#include "comparisons/bench/in_child.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <nlohmann/json.hpp>

#include "comparisons/bench/interrupt.h"

namespace springproof::bench {
namespace {

using Json = nlohmann::json;

std::atomic<pid_t> forked = 0;

[[noreturn]] void answer(const std::function<Json()>& work, int to) {
  std::signal(SIGINT, SIG_IGN);  // the parent kills the child
  std::signal(SIGTERM, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  Json reply;
  try {
    reply = {{"value", work()}};
  } catch (const std::exception& e) {
    reply = {{"error", e.what()}};
  }
  const std::string text = reply.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::size_t sent = 0;
  while (sent < text.size()) {
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

void interrupt_forked_child() {
  if (const pid_t child = forked; child > 0) kill(child, SIGKILL);
}

Json in_child(const std::function<Json()>& work) {
  throw_if_interrupted();
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    close(ends[0]);
    answer(work, ends[1]);
  }
  forked = child;
  close(ends[1]);
  if (interrupted()) interrupt_forked_child();
  const std::string text = read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  forked = 0;
  throw_if_interrupted();
  const Json reply = Json::parse(text, nullptr, false);
  if (reply.is_discarded())
    throw std::runtime_error(WIFSIGNALED(status)
                                 ? fmt::format("was killed by signal {} (out of memory?)", WTERMSIG(status))
                                 : std::string("ended early"));
  if (reply.contains("error")) throw std::runtime_error(reply.at("error").get<std::string>());
  return reply.at("value");
}

}  // namespace springproof::bench
