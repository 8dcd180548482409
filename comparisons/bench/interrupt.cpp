#include "comparisons/bench/interrupt.h"

#include <atomic>
#include <csignal>

#include "problem/system/child.h"

namespace springproof::bench {
namespace {

std::atomic<bool> is_interrupted = false;

void on_interrupt(int) {
  is_interrupted = true;
  interrupt_children();
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

bool interrupted() { return is_interrupted; }

void throw_if_interrupted() {
  if (is_interrupted) throw Interrupted();
}

}  // namespace springproof::bench
