// What programs say: nothing here throws, and what was lost of standard output is told by the exit status.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string_view>

namespace springproof {

/// Writes to standard output.  What cannot be written is lost, and run_as_program() tells it at the end.
void write_to_stdout(std::string_view text) noexcept;

/// Writes to standard error: progress, notes, errors.  A log that is closed or full is no reason to end a run.
void write_to_stderr(std::string_view text) noexcept;

/// write_to_stdout() of a formatted text.
template <class... Values>
void to_stdout(fmt::format_string<Values...> format, Values&&... values) {
  write_to_stdout(fmt::format(format, std::forward<Values>(values)...));
}

/// write_to_stderr() of a formatted text.
template <class... Values>
void to_stderr(fmt::format_string<Values...> format, Values&&... values) {
  write_to_stderr(fmt::format(format, std::forward<Values>(values)...));
}

/// The body of main(): runs the program with its three standard streams open and without SIGPIPE, and says its errors.
/// @return its status; of an error 2 if the input is unusable, else 1; never 0 if standard output was lost.
int run_as_program(const std::function<int()>& program);

}  // namespace springproof
