#include "problem/processes/interrupts.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <list>

#include "problem/processes/child.h"

namespace springproof {
namespace {

constexpr unsigned patience = 2;  // seconds

std::atomic<const std::string*> last_words = nullptr;

// Only async-signal-safe calls in the handlers.
[[noreturn]] void end_now(int) {
  constexpr char clear_line[] = "\r\x1b[K";
  if (isatty(STDERR_FILENO) && write(STDERR_FILENO, clear_line, sizeof clear_line - 1) < 0) _exit(interrupted_status);
  if (const std::string* words = last_words)
    if (write(STDERR_FILENO, words->data(), words->size()) < 0) _exit(interrupted_status);
  _exit(interrupted_status);
}

void on_interrupt(int signal) {
  if (children_interrupted()) end_now(signal);
  interrupt_children();
  alarm(patience);
}

}  // namespace

void end_at_interrupts() {
  std::signal(SIGALRM, end_now);
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

void set_last_words(const std::string& words) {
  static std::list<std::string> all;  // none is freed: a signal handler may be writing it
  last_words = &all.emplace_back(words + '\n');
}

}  // namespace springproof
