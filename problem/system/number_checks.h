// Numbers that options allow.  Messages of CLI11's own checks print the largest double in 309 digits.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace springproof {

/// For CLI::Option::check: a finite number > 0, or where `zero` is allowed >= 0.
inline CLI::Validator positive(bool zero = false) {
  const auto refusal = [zero](const std::string& text) -> std::string {
    double x = 0;
    if (CLI::detail::lexical_cast(text, x) && std::isfinite(x) && (x > 0 || (zero && x == 0))) return "";
    return "is " + text + " (allowed: a finite number " + (zero ? ">= 0)" : "> 0)");
  };
  return CLI::Validator(zero ? "NONNEGATIVE" : "POSITIVE").operation(refusal);
}

}  // namespace springproof
