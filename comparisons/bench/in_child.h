// Work in a process of its own: its memory is its own, and it can be ended.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>

namespace springproof::bench {

/// Runs `work` in a fork of this process and returns what it returned.
/// @throws std::runtime_error with the message of what the work threw, or with how it ended (memory, signal);
/// Interrupted.
nlohmann::json in_child(const std::function<nlohmann::json()>& work);

/// Ends the one under way; may be called in a signal handler.
void interrupt_forked_child();

}  // namespace springproof::bench
