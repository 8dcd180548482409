#include "problem/system/input_error.h"

#include <fmt/format.h>

#include "problem/system/shortened.h"

namespace springproof {
namespace {

std::string located(const SourceLocation& where, const std::string& message) {
  if (where.file.empty()) return message;
  if (where.line == 0) return fmt::format("{}: {}", where.file, message);
  return fmt::format("{}:{}:{}: {}", where.file, where.line, where.column, message);
}

}  // namespace

InputError::InputError(const SourceLocation& where, const std::string& message)
    : std::runtime_error(located(where, shortened(message))) {}

}  // namespace springproof
