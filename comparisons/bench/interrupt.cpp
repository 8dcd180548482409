#include "comparisons/bench/interrupt.h"

#include <atomic>
#include <csignal>
#include <nlohmann/json.hpp>

#include "problem/processes/child.h"

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

nlohmann::json in_child(const std::function<nlohmann::json()>& work) try {
  throw_if_interrupted();
  const std::string text =
      springproof::in_child([&] { return work().dump(-1, ' ', false, nlohmann::json::error_handler_t::replace); });
  throw_if_interrupted();
  return nlohmann::json::parse(text);
} catch (const std::runtime_error&) {
  throw_if_interrupted();  // which ended the child
  throw;
}

}  // namespace springproof::bench
