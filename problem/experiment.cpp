#include "problem/experiment.h"

#include <fmt/format.h>

namespace springproof {
namespace {

std::string located(const SourceLocation& where, const std::string& message) {
  if (where.line == 0) return fmt::format("{}: {}", where.file, message);
  return fmt::format("{}:{}:{}: {}", where.file, where.line, where.column, message);
}

}  // namespace

InputError::InputError(const SourceLocation& where, const std::string& message)
    : std::runtime_error(located(where, message)) {}

std::string to_string(Source source) {
  switch (source) {
    case Source::analytic: return "analytic";
    case Source::extrapolated_fem: return "extrapolated FEM";
    case Source::published: return "published";
    case Source::regression: return "regression";
  }
  return "unknown";
}

}  // namespace springproof
