// Interrupts, after which a bench shows what it has measured so far, and work in child processes, which they end.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>

namespace springproof::bench {

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// @throws Interrupted once the children are (problem/processes/child.h).
void throw_if_interrupted();

/// Runs work in a child process, which has its own memory and can be killed: springproof::in_child() for JSON.
/// @throws Interrupted
nlohmann::json in_child(const std::function<nlohmann::json()>& work);

}  // namespace springproof::bench
