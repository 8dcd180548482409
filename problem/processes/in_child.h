// Runs work in a fork of this process, which has its own memory and can be killed.
#pragma once

#include <functional>
#include <string>

namespace springproof {

/// Returns what `work` returned, called in a child process.  interrupt_children() ends it.
/// @throws std::runtime_error with the message of the exception thrown by the work, or with how the process ended
/// (memory, signal).
std::string in_child(const std::function<std::string()>& work);

}  // namespace springproof
