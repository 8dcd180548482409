// Interrupts (SIGINT, as of Ctrl-C, and SIGTERM) of a program: it ends soon, whatever it is at.
#pragma once

#include <string>

namespace springproof {

/// Exit status of a program that was interrupted.
inline constexpr int interrupted_status = 130;

/// From here on the first interrupt ends the child processes (children_interrupted()) and gives the program two
/// seconds to end by itself; then, or at a second interrupt, it ends with status 130 wherever it is.  Files are either
/// whole or not there (write_file()).
void end_at_interrupts();

/// Said on standard error by a program that does not end by itself after an interrupt; one line.
void set_last_words(const std::string& words);

}  // namespace springproof
