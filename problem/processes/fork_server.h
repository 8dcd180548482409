// A program that is started once and forks for every run, because starting it takes long: half a second of the dynamic
// linker for the 200 libraries behind deal.II.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "problem/processes/child.h"

namespace springproof {

/// The argument with which a program becomes a fork server.
inline constexpr const char* fork_server_argument = "--fork-server";

/// Runs the program to its end like run_child(), in a fork of a server of it, which is started where none is idle and
/// ends with this process.  interrupt_children() ends the run too.  Thread-safe.
/// @param program calls serve_forks() when its only argument is fork_server_argument
/// @param arguments none of them empty
/// @param output, errors files
/// @throws std::runtime_error if it cannot be started.
ChildEnd run_forked(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                    const std::filesystem::path& output, const std::filesystem::path& errors);

/// The program's side: answers run_forked() until the caller ends.
/// @param run main() of the program, called in a process of its own; no thread may have been started before
/// @return the exit status
int serve_forks(int (*run)(int argc, char** argv));

}  // namespace springproof
