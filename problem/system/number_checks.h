// Numbers that options allow.  Messages of CLI11's own checks print the largest double in 309 digits.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace springproof {

/// For CLI::Option::check: a finite number > 0.
inline CLI::Validator positive() {
  const auto refusal = [](const std::string& text) -> std::string {
    double x = 0;
    if (CLI::detail::lexical_cast(text, x) && std::isfinite(x) && x > 0) return "";
    return "is " + text + " (allowed: a finite number > 0)";
  };
  return CLI::Validator("POSITIVE").operation(refusal);
}

}  // namespace springproof
