// Runs work in a child process, which has its own memory and can be killed.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>

namespace springproof::bench {

/// Runs `work` in a fork of this process and returns what it returned.
/// @throws std::runtime_error with the message of the exception thrown by the work, or with how the process ended
/// (memory, signal); Interrupted.
nlohmann::json in_child(const std::function<nlohmann::json()>& work);

/// Kills the running child; may be called in a signal handler.
void interrupt_forked_child();

}  // namespace springproof::bench
