// Errors in an input, with their location.
#pragma once

#include <stdexcept>
#include <string>

namespace springproof {

/// Location in a case file; line and column count from 1, 0 = unknown.
struct SourceLocation {
  std::string file;  ///< its name
  int line = 0;      ///< from 1
  int column = 0;    ///< from 1
};

/// An input that cannot be used.  what() reads "file:line:column: key: what is wrong, what is allowed".
class InputError : public std::runtime_error {
 public:
  /// With its location.
  InputError(const SourceLocation& where, const std::string& message);
  /// Without one.
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace springproof
